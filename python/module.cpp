// signorini._signorini: the C API as Python classes. Arrays come in as they are where their layout
// allows and go out as views; the GIL is released while a solver runs.
#include <signorini/c/signorini.h>

#include <memory>
#include <mutex>
#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Integers = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;

void check(signorini_error error) {
  switch (error) {
    case SIGNORINI_OK: return;
    case SIGNORINI_INVALID_ARGUMENT: throw py::value_error(signorini_last_error());
    case SIGNORINI_OUT_OF_MEMORY: throw std::bad_alloc();
    default: throw std::runtime_error(signorini_last_error());
  }
}

/// An array with one axis of a known length, for C functions that take a pointer alone.
template <typename Array>
const auto* data_of(const Array& array, py::ssize_t length, const char* name) {
  if (array.ndim() != 1 || array.shape(0) != length) {
    std::string got;
    for (py::ssize_t axis = 0; axis < array.ndim(); ++axis) {
      got += (axis == 0 ? "" : ", ") + std::to_string(array.shape(axis));
    }
    throw py::value_error(std::string(name) + ": must have the shape (" + std::to_string(length) +
                          ",), got (" + got + (array.ndim() == 1 ? ",)" : ")"));
  }
  return array.data();
}

const double* data_or_null(const std::optional<Numbers>& array, py::ssize_t length,
                           const char* name) {
  return array ? data_of(*array, length, name) : nullptr;
}

/// Numbers that `owner` keeps alive, not copied.
py::array view(const double* data, std::vector<py::ssize_t> shape, const py::object& owner,
               bool writeable = false) {
  py::array_t<double> array(std::move(shape), data, owner);
  if (!writeable) {
    array.attr("flags").attr("writeable") = false;
  }
  return array;
}

py::dict to_dict(const signorini_certificate& c) {
  using namespace py::literals;
  return py::dict("natural_residual"_a = c.natural_residual,
                  "unit_free_residual"_a = c.unit_free_residual,
                  "rounding_floor"_a = c.rounding_floor, "natural_floor"_a = c.natural_floor,
                  "backward_error"_a = c.backward_error, "min_z"_a = c.min_z, "min_w"_a = c.min_w,
                  "complementarity"_a = c.complementarity, "cone_violation"_a = c.cone_violation,
                  "worst_row"_a = c.worst_row);
}

py::dict to_dict(const signorini_statistics& s) {
  using namespace py::literals;
  return py::dict("iterations"_a = s.iterations, "pivots"_a = s.pivots,
                  "factorizations"_a = s.factorizations, "refinements"_a = s.refinements,
                  "factor_bytes"_a = s.factor_bytes, "solve_seconds"_a = s.solve_seconds);
}

/// A C handle, made and destroyed with its Python object.
template <typename Handle, signorini_error (*create)(Handle**), void (*destroy)(Handle*)>
class Owned {
 public:
  Owned() {
    Handle* made = nullptr;
    check(create(&made));
    handle_.reset(made);
  }
  [[nodiscard]] Handle* get() const { return handle_.get(); }

 private:
  struct Destroy {
    void operator()(Handle* handle) const { destroy(handle); }
  };
  std::unique_ptr<Handle, Destroy> handle_;
};

using Problem = Owned<signorini_problem, signorini_problem_create, signorini_problem_destroy>;
using Result = Owned<signorini_result, signorini_result_create, signorini_result_destroy>;
using ContactResult = Owned<signorini_contact_result, signorini_contact_result_create,
                            signorini_contact_result_destroy>;

/// A solver with a lock: the GIL is not held while it runs.
struct Solver {
  explicit Solver(const std::string& name) {
    signorini_solver* made = nullptr;
    check(signorini_solver_create(name.c_str(), &made));
    handle.reset(made);
  }
  struct Destroy {
    void operator()(signorini_solver* solver) const { signorini_solver_destroy(solver); }
  };
  std::unique_ptr<signorini_solver, Destroy> handle;
  std::mutex lock;
};

struct ContactSolver {
  Owned<signorini_contact_solver, signorini_contact_solver_create, signorini_contact_solver_destroy>
      handle;
  std::mutex lock;
};

std::int64_t square(const py::array_t<double>& M) {
  if (M.ndim() != 2 || M.shape(0) != M.shape(1)) {
    throw py::value_error("M: must be square, with two axes");
  }
  return M.shape(0);
}

void set_dense(Problem& self, const py::array_t<double>& M, const Numbers& q) {
  const std::int64_t n = square(M);
  const double* right = data_of(q, n, "q");
  if ((M.flags() & py::array::f_style) != 0) {
    check(signorini_problem_set_dense(self.get(), n, SIGNORINI_COLUMN_MAJOR, M.data(), right));
  } else {
    const Numbers by_rows = M;  // copies where it is neither by rows nor by columns
    check(signorini_problem_set_dense(self.get(), n, SIGNORINI_ROW_MAJOR, by_rows.data(), right));
  }
}

void set_sparse(Problem& self, bool by_rows, const Integers& start, const Integers& index,
                const Numbers& value, const Numbers& q) {
  const py::ssize_t n = q.size();
  check(signorini_problem_set_sparse(
      self.get(), n, by_rows ? SIGNORINI_ROW_MAJOR : SIGNORINI_COLUMN_MAJOR, value.size(),
      data_of(start, n + 1, "M.indptr"), data_of(index, value.size(), "M.indices"), value.data(),
      data_of(q, n, "q")));
}

void set_factored(Problem& self, const Integers& start, const Integers& index, const Numbers& value,
                  const Integers& block_size, const Numbers& block_value, bool is_mass,
                  const std::optional<Numbers>& compliance, const Numbers& q) {
  const py::ssize_t n = q.size();
  std::int64_t numbers = 0;
  for (py::ssize_t k = 0; k < block_size.size(); ++k) {
    numbers += std::int64_t{block_size.data()[k]} * block_size.data()[k];
  }
  check(signorini_problem_set_factored(
      self.get(), n, value.size(), data_of(start, n + 1, "J.indptr"),
      data_of(index, value.size(), "J.indices"), value.data(), block_size.size(), block_size.data(),
      is_mass ? SIGNORINI_MASS : SIGNORINI_INVERSE_MASS, data_of(block_value, numbers, "blocks"),
      data_or_null(compliance, n, "compliance"), data_of(q, n, "q")));
}

void set_bounds(Problem& self, const std::optional<Numbers>& lower,
                const std::optional<Numbers>& upper) {
  const std::int64_t n = signorini_problem_size(self.get());
  check(signorini_problem_set_bounds(self.get(), n, data_or_null(lower, n, "lower"),
                                     data_or_null(upper, n, "upper")));
}

void set_limits(Problem& self, const Integers& row, const Integers& normal_row,
                const Numbers& coefficient) {
  check(signorini_problem_set_limits(self.get(), row.size(), row.data(),
                                     data_of(normal_row, row.size(), "normal_row"),
                                     data_of(coefficient, row.size(), "coefficient")));
}

void set_cones(Problem& self, const Integers& normal_row, const Integers& dimension,
               const Numbers& coefficient, bool associated) {
  check(signorini_problem_set_cones(self.get(), normal_row.size(), normal_row.data(),
                                    data_of(dimension, normal_row.size(), "dimension"),
                                    data_of(coefficient, normal_row.size(), "coefficient"),
                                    associated ? SIGNORINI_ASSOCIATED : SIGNORINI_COULOMB));
}

std::unique_ptr<Result> solve(Solver& self, const Problem& problem,
                              const std::optional<Numbers>& warm_start) {
  auto result = std::make_unique<Result>();
  const double* start =
      data_or_null(warm_start, signorini_problem_size(problem.get()), "warm_start");
  signorini_error error = SIGNORINI_OK;
  {
    const py::gil_scoped_release released;
    const std::lock_guard<std::mutex> alone(self.lock);
    error = signorini_solver_solve(self.handle.get(), problem.get(), start, result->get());
  }
  check(error);
  return result;
}

py::list attempts(const Result& self) {
  using namespace py::literals;
  py::list all;
  for (std::int64_t k = 0; k < signorini_result_attempt_count(self.get()); ++k) {
    signorini_attempt a{};
    check(signorini_result_attempt(self.get(), k, &a, sizeof a));
    all.append(py::dict(
        "solver"_a = a.solver, "reason"_a = a.reason, "status"_a = signorini_status_text(a.status),
        "detail"_a = a.detail, "natural_residual"_a = a.natural_residual,
        "unit_free_residual"_a = a.unit_free_residual, "iterations"_a = a.iterations,
        "pivots"_a = a.pivots, "solve_seconds"_a = a.solve_seconds));
  }
  return all;
}

py::list island_certificates(const Result& self) {
  py::list all;
  for (std::int64_t k = 0; k < signorini_result_island_count(self.get()); ++k) {
    signorini_certificate c{};
    check(signorini_result_island_certificate(self.get(), k, &c, sizeof c));
    all.append(to_dict(c));
  }
  return all;
}

/// The structs of a contiguous array of bytes, not copied.
template <typename Struct>
std::pair<std::int64_t, const Struct*> structs_of(const py::buffer& buffer, const char* name) {
  const py::buffer_info info = buffer.request();
  if (info.ndim != 1 || info.itemsize != sizeof(Struct) ||
      (info.shape[0] > 1 && info.strides[0] != sizeof(Struct))) {
    throw py::value_error(std::string(name) + ": must be a contiguous array of signorini's dtype");
  }
  return {info.shape[0], static_cast<const Struct*>(info.ptr)};
}

std::unique_ptr<ContactResult> solve_contacts(ContactSolver& self, double step,
                                              const py::buffer& bodies,
                                              const py::buffer& contacts) {
  auto result = std::make_unique<ContactResult>();
  const auto [body_count, body] = structs_of<signorini_body>(bodies, "bodies");
  const auto [contact_count, contact] = structs_of<signorini_contact>(contacts, "contacts");
  signorini_error error = SIGNORINI_OK;
  {
    const py::gil_scoped_release released;
    const std::lock_guard<std::mutex> alone(self.lock);
    error = signorini_contact_solver_solve(self.handle.get(), step, body_count, body, contact_count,
                                           contact, result->get());
  }
  check(error);
  return result;
}

py::list islands(const ContactResult& self) {
  using namespace py::literals;
  py::list all;
  for (std::int64_t k = 0; k < signorini_contact_result_island_count(self.get()); ++k) {
    signorini_island i{};
    check(signorini_contact_result_island(self.get(), k, &i, sizeof i));
    all.append(py::dict("bodies"_a = i.bodies, "contacts"_a = i.contacts, "rows"_a = i.rows,
                        "status"_a = signorini_status_text(i.status),
                        "unit_free_residual"_a = i.unit_free_residual, "residual"_a = i.residual,
                        "work"_a = i.work));
  }
  return all;
}

std::vector<std::string> solver_names() {
  std::vector<std::string> names;
  for (const char* const* name = signorini_solver_names(); *name != nullptr; ++name) {
    names.emplace_back(*name);
  }
  return names;
}

void bind_lcp(py::module_& module) {
  py::class_<Problem>(module, "Problem")
      .def(py::init<>())
      .def("set_dense", &set_dense)
      .def("set_sparse", &set_sparse)
      .def("set_factored", &set_factored)
      .def("set_bounds", &set_bounds)
      .def("set_limits", &set_limits)
      .def("set_cones", &set_cones)
      .def("size", [](const Problem& self) { return signorini_problem_size(self.get()); })
      .def("q",
           [](const py::object& self) {
             signorini_problem* problem = self.cast<Problem&>().get();
             return view(signorini_problem_q(problem), {signorini_problem_size(problem)}, self,
                         true);
           })
      .def("matrix", [](const py::object& self) -> py::object {
        std::int64_t count = 0;
        double* values = signorini_problem_matrix(self.cast<Problem&>().get(), &count);
        if (values == nullptr) {
          return py::none();
        }
        return view(values, {count}, self, true);
      });

  py::class_<Solver>(module, "Solver")
      .def(py::init<const std::string&>())
      .def("set_number",
           [](Solver& self, const std::string& name, double value) {
             const std::lock_guard<std::mutex> alone(self.lock);
             check(signorini_solver_set_number(self.handle.get(), name.c_str(), value));
           })
      .def("set_text",
           [](Solver& self, const std::string& name, const std::string& value) {
             const std::lock_guard<std::mutex> alone(self.lock);
             check(signorini_solver_set_text(self.handle.get(), name.c_str(), value.c_str()));
           })
      .def("solve", &solve);

  const auto vector_of = [](auto getter) {
    return [getter](const py::object& self) {
      const signorini_result* result = self.cast<Result&>().get();
      return view(getter(result), {signorini_result_size(result)}, self);
    };
  };
  py::class_<Result>(module, "Result")
      .def("status",
           [](const Result& self) {
             return signorini_status_text(signorini_result_status(self.get()));
           })
      .def("is_solved",
           [](const Result& self) {
             return signorini_is_solved(signorini_result_status(self.get())) != 0;
           })
      .def("solver", [](const Result& self) { return signorini_result_solver(self.get()); })
      .def("detail", [](const Result& self) { return signorini_result_detail(self.get()); })
      .def("z", vector_of(signorini_result_z))
      .def("w", vector_of(signorini_result_w))
      .def("ray",
           [vector_of](const py::object& self) -> py::object {
             const bool has_ray = signorini_result_ray(self.cast<Result&>().get()) != nullptr;
             return has_ray ? vector_of(signorini_result_ray)(self) : py::object(py::none());
           })
      .def("ray_bound", [](const Result& self) { return signorini_result_ray_bound(self.get()); })
      .def("certificate",
           [](const Result& self) {
             signorini_certificate certificate{};
             check(signorini_result_certificate(self.get(), &certificate, sizeof certificate));
             return to_dict(certificate);
           })
      .def("statistics",
           [](const Result& self) {
             signorini_statistics statistics{};
             check(signorini_result_statistics(self.get(), &statistics, sizeof statistics));
             return to_dict(statistics);
           })
      .def("attempts", &attempts)
      .def("island_certificates", &island_certificates)
      .def("island_of_row", [](const Result& self) -> py::object {
        const std::int32_t* island = signorini_result_island_of_row(self.get());
        if (island == nullptr) {
          return py::none();
        }
        return py::array_t<std::int32_t>(signorini_result_size(self.get()), island);
      });
}

void bind_contacts(py::module_& module) {
  py::class_<ContactSolver>(module, "ContactSolver")
      .def(py::init<>())
      .def("set_number",
           [](ContactSolver& self, const std::string& name, double value) {
             const std::lock_guard<std::mutex> alone(self.lock);
             check(signorini_contact_solver_set_number(self.handle.get(), name.c_str(), value));
           })
      .def("set_text",
           [](ContactSolver& self, const std::string& name, const std::string& value) {
             const std::lock_guard<std::mutex> alone(self.lock);
             check(
                 signorini_contact_solver_set_text(self.handle.get(), name.c_str(), value.c_str()));
           })
      .def("solve", &solve_contacts);

  const auto rows_of = [](auto getter, auto count, py::ssize_t width) {
    return [getter, count, width](const py::object& self) {
      const signorini_contact_result* result = self.cast<ContactResult&>().get();
      return view(getter(result), {count(result), width}, self);
    };
  };
  py::class_<ContactResult>(module, "ContactResult")
      .def("status",
           [](const ContactResult& self) {
             return signorini_status_text(signorini_contact_result_status(self.get()));
           })
      .def("is_solved",
           [](const ContactResult& self) {
             return signorini_is_solved(signorini_contact_result_status(self.get())) != 0;
           })
      .def("detail",
           [](const ContactResult& self) { return signorini_contact_result_detail(self.get()); })
      .def("velocities",
           rows_of(signorini_contact_result_velocities, signorini_contact_result_body_count, 6))
      .def("impulses",
           rows_of(signorini_contact_result_impulses, signorini_contact_result_contact_count, 3))
      .def("normal_impulses",
           [](const py::object& self) {
             const signorini_contact_result* result = self.cast<ContactResult&>().get();
             return view(signorini_contact_result_normal_impulses(result),
                         {signorini_contact_result_contact_count(result)}, self);
           })
      .def("energy_change",
           [](const ContactResult& self) {
             return signorini_contact_result_energy_change(self.get());
           })
      .def("certificate",
           [](const ContactResult& self) {
             signorini_certificate certificate{};
             check(signorini_contact_result_certificate(self.get(), &certificate,
                                                        sizeof certificate));
             return to_dict(certificate);
           })
      .def("accuracy",
           [](const ContactResult& self) { return signorini_contact_result_accuracy(self.get()); })
      .def("work",
           [](const ContactResult& self) { return signorini_contact_result_work(self.get()); })
      .def("is_deterministic",
           [](const ContactResult& self) {
             return signorini_contact_result_is_deterministic(self.get()) != 0;
           })
      .def("islands", &islands)
      .def("island_of_contact", [](const ContactResult& self) {
        return py::array_t<std::int32_t>(signorini_contact_result_contact_count(self.get()),
                                         signorini_contact_result_island_of_contact(self.get()));
      });
}

}  // namespace

PYBIND11_MODULE(_signorini, module) {
  module.doc() = "The C API of Signorini; use the package signorini.";
  module.attr("version") = signorini_version();
  module.attr("body_bytes") = sizeof(signorini_body);
  module.attr("contact_bytes") = sizeof(signorini_contact);
  module.def("solver_names", &solver_names);
  bind_lcp(module);
  bind_contacts(module);
}
