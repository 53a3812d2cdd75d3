#include <signorini/core/response/accuracy.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/time_stepper.h>
#include <signorini/lcp/solve_recorder.h>

#include "../lcp/allocation_count.h"
#include "plane_contacts.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace signorini {
namespace {

using testing_tools::at;
using testing_tools::ball_body;
using testing_tools::box_body;
using testing_tools::fixed_body;
using testing_tools::PlaneContacts;
using testing_tools::TestBall;
using testing_tools::TestBody;
using testing_tools::TestBox;

const Vec3 kHalf(0.5, 0.4, 0.2);

/// Stacks of three boxes on a plane, some of them pushed, and a ball that rolls between: `stacks`
/// islands and one.
struct Yard {
  explicit Yard(int stacks) {
    std::vector<testing_tools::TestBody> shapes;
    std::vector<std::pair<int, int>> on;
    bodies.push_back(fixed_body());
    state.push_back(at(Vec3::Zero()));
    const auto add = [&](const Body& body, const Vec3& x, const Vec3& v, const TestBody& shape) {
      bodies.push_back(body);
      state.push_back(at(x));
      state.back().p = body.mass * v;
      shapes.push_back(shape);
    };
    for (int k = 0; k < stacks; ++k) {
      for (int floor = 0; floor < 3; ++floor) {
        const Vec3 push(k % 2 == 0 ? 0.5 * k : 0.0, 0.1 * k, 0.0);
        add(box_body(1.0 + floor, kHalf), Vec3(3.0 * k, 0.0, 0.2 + 0.4 * floor),
            floor == 2 ? push : Vec3::Zero(), {TestBox{kHalf}, {0.4, 0.0}});
        if (floor > 0) {
          on.emplace_back(3 * k + floor + 1, 3 * k + floor);
        }
      }
    }
    add(ball_body(1.0, 0.5), Vec3(0.0, 5.0, 0.5), Vec3(2.0, 0.0, 0.0), {TestBall{0.5}, {0.4, 0.0}});
    finder.emplace_back(Vec3::UnitZ(), shapes);
    for (const auto& [upper, lower] : on) {
      finder.back().stack(upper, lower);
    }
  }
  Bodies bodies;
  State state;
  std::vector<PlaneContacts> finder;
};

TimeStepSettings dial(const Accuracy& accuracy) {
  TimeStepSettings settings;
  settings.accuracy = accuracy;
  return settings;
}

TEST(Accuracy, IsNamedOrAResidual) {
  EXPECT_EQ(Accuracy::named("game"), Accuracy::game());
  EXPECT_EQ(Accuracy::named("1e-6").residual(), 1e-6);
  EXPECT_EQ(Accuracy::reference().name(), "reference");
  EXPECT_EQ(Accuracy(2.5e-6).name(), "2.5e-06 m/s");
  for (const char* bad : {"", "gaming", "0", "-1", "nan", "inf", "1e-3x"}) {
    EXPECT_THROW((void)Accuracy::named(bad), std::invalid_argument) << bad;
  }
}

TEST(Accuracy, EveryPositionMeetsItsResidualAndSaysWhatItChose) {
  for (const char* name : {"preview", "game", "engineering", "reference", "1e-6"}) {
    SCOPED_TRACE(name);
    Yard yard(4);
    const Accuracy accuracy = Accuracy::named(name);
    TimeStepper stepper(yard.bodies, yard.finder.back(), dial(accuracy));
    StepReport report;
    for (int k = 0; k < 30; ++k) {
      stepper.step(yard.state, report);
      EXPECT_TRUE(lcp::is_solved(report.status)) << k << ": " << report.detail;
      EXPECT_EQ(report.detail, "");
      for (const IslandReport& island : report.islands) {
        if (island.status == lcp::Status::kSolved) {
          EXPECT_LE(island.residual, accuracy.residual() * (1.0 + 1e-9));
        }
      }
    }
    EXPECT_EQ(report.accuracy, accuracy.name());
    EXPECT_TRUE(report.is_deterministic);
    EXPECT_EQ(report.islands.back().model, "single contact, cone");
    EXPECT_NE(to_text(report).find("accuracy: " + accuracy.name()), std::string::npos);
  }
}

TEST(Accuracy, IsNotCalledSolvedWhereRoundingIsAboveTheResidual) {
  Yard yard(1);
  yard.state[3].p = Vec3(3e4, 1e4, -1e4);  // q of 1e4 m/s: 1e-13 m/s are 1e-17 of it
  yard.state[4].p = Vec3(1e4, 0.0, -1e4);
  TimeStepper stepper(yard.bodies, yard.finder.back(), dial(Accuracy::reference()));
  StepReport report;
  stepper.step(yard.state, report);
  ASSERT_EQ(report.islands.size(), 2u);
  for (const IslandReport& island : report.islands) {
    EXPECT_TRUE(island.residual <= 1e-13 || island.status != lcp::Status::kSolved)
        << island.solver << " " << island.residual;
  }
}

TEST(Accuracy, ABudgetTooSmallForAFactorisationIsSweptAway) {
  Yard yard(1);
  TimeStepSettings settings = dial(Accuracy::engineering());
  settings.budget.work = 1.0;  // 27 sweeps of 37 rows, not one factorisation
  TimeStepper stepper(yard.bodies, yard.finder.back(), settings);
  StepReport report;
  stepper.step(yard.state, report);
  EXPECT_GT(report.work, 0.5);
  EXPECT_LE(report.work, 1.0 + 1e-9);
  EXPECT_EQ(report.islands[0].solver, "nsgs");
}

TEST(Accuracy, ABudgetThatRunsOutGivesTheBestIterateAndSaysSo) {
  for (const double work : {0.0, 0.05, 3.0}) {
    SCOPED_TRACE(work);
    std::vector<State> ends;
    for (int run = 0; run < 2; ++run) {
      Yard yard(4);
      TimeStepSettings settings = dial(Accuracy::reference());
      settings.budget.work = work;
      TimeStepper stepper(yard.bodies, yard.finder.back(), settings);
      StepReport report;
      for (int k = 0; k < 3; ++k) {
        stepper.step(yard.state, report);
        EXPECT_LE(report.work, work + 1e-9);
        EXPECT_TRUE(report.is_deterministic);
        for (const IslandReport& island : report.islands) {
          EXPECT_GE(island.unit_free_residual, 0.0);  // certified
        }
      }
      if (work < 1.0) {
        EXPECT_EQ(report.status, lcp::Status::kIterationLimit);
        EXPECT_NE(report.detail.find("best iterate applied"), std::string::npos);
        EXPECT_NE(report.result.detail.find("budget used up"), std::string::npos);
      }
      ends.push_back(yard.state);
    }
    for (std::size_t k = 0; k < ends[0].size(); ++k) {
      EXPECT_EQ(ends[0][k].p, ends[1][k].p);
    }
  }
}

TEST(Accuracy, ABudgetOfSecondsIsMarked) {
  Yard yard(2);
  TimeStepSettings settings = dial(Accuracy::engineering());
  settings.budget.seconds = 1e-9;
  TimeStepper stepper(yard.bodies, yard.finder.back(), settings);
  StepReport report;
  stepper.step(yard.state, report);
  EXPECT_FALSE(report.is_deterministic);
  EXPECT_EQ(report.status, lcp::Status::kTimeLimit);
  EXPECT_NE(to_text(report).find("not deterministic"), std::string::npos);
  settings.budget.seconds = 1e3;
  TimeStepper patient(yard.bodies, yard.finder.back(), settings);
  patient.step(yard.state, report);
  EXPECT_TRUE(lcp::is_solved(report.status));
}

TEST(Accuracy, BadBudgetsAndThreadsNameTheField) {
  Yard yard(1);
  const auto said = [&](TimeStepSettings settings) -> std::string {
    try {
      TimeStepper(yard.bodies, yard.finder.back(), settings);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  TimeStepSettings settings = dial(Accuracy::game());
  settings.budget.work = -1.0;
  EXPECT_NE(said(settings).find("work"), std::string::npos);
  settings.budget = {.seconds = 0.0};
  EXPECT_NE(said(settings).find("seconds"), std::string::npos);
  settings = {};
  settings.budget.work = 10.0;
  EXPECT_NE(said(settings).find("accuracy"), std::string::npos);
  settings = {};
  settings.threads = 0;
  EXPECT_NE(said(settings).find("threads"), std::string::npos);
}

void expect_same_bits(const State& a, const State& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].x, b[k].x) << k;
    EXPECT_EQ(a[k].q.coeffs(), b[k].q.coeffs()) << k;
    EXPECT_EQ(a[k].p, b[k].p) << k;
    EXPECT_EQ(a[k].L, b[k].L) << k;
  }
}

/// Nine stacks, the last two joined: three kinds of island.
State yard_after(const Accuracy& accuracy, int threads) {
  Yard yard(9);
  Joints joints{joint_at(JointKind::kBall, 24, 27, yard.state, Vec3(22.5, 0.0, 1.0))};
  joints.push_back(joint_at(JointKind::kHinge, 21, 0, yard.state, Vec3(18.0, 0.0, 1.0)));
  TimeStepSettings settings = dial(accuracy);
  settings.threads = threads;
  TimeStepper stepper(yard.bodies, yard.finder.back(), settings, joints);
  StepReport report;
  for (int k = 0; k < 25; ++k) {
    stepper.step(yard.state, report);
  }
  EXPECT_EQ(report.islands.size(), 9u);
  return yard.state;
}

TEST(Threads, AnyNumberGivesTheSameBits) {
  for (const Accuracy& accuracy :
       {Accuracy::preview(), Accuracy::game(), Accuracy::engineering(), Accuracy::reference()}) {
    SCOPED_TRACE(accuracy.name());
    const State alone = yard_after(accuracy, 1);
    for (const int threads : {2, 4, 8}) {
      SCOPED_TRACE(threads);
      expect_same_bits(yard_after(accuracy, threads), alone);
    }
  }
}

TEST(Threads, AnExceptionComesThrough) {
  Yard yard(3);
  TimeStepSettings settings;
  settings.friction_model = FrictionModel::kCone;
  settings.cone_solver = "lemke";  // refuses cones
  settings.threads = 4;
  TimeStepper stepper(yard.bodies, yard.finder.back(), settings);
  StepReport report;
  const State before = yard.state;
  EXPECT_THROW(stepper.step(yard.state, report), std::invalid_argument);
  EXPECT_EQ(yard.state[3].p, before[3].p);
}

/// Momenta after a step, with the full model and with the reduced one.
void expect_same_velocities(const Bodies& bodies, const State& start, ContactFinder& finder,
                            StepReport& reduced) {
  std::vector<State> ends(2, start);
  for (const bool full : {true, false}) {
    TimeStepSettings settings = dial(Accuracy::reference());
    settings.full_model = full;
    TimeStepper stepper(bodies, finder, settings);
    StepReport report;
    stepper.step(ends[full ? 1 : 0], report);
    EXPECT_TRUE(lcp::is_solved(report.status)) << report.detail;
    EXPECT_EQ(report.contacts_apart, full ? 0 : report.contacts_apart);
    EXPECT_LE(report.islands.size(), full ? 1u : bodies.size());
    if (!full) {
      reduced = report;
    } else {
      EXPECT_GE(report.rows, 0);
    }
  }
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Velocity a = velocity(bodies[k], ends[0][k]);
    const Velocity b = velocity(bodies[k], ends[1][k]);
    EXPECT_LE((a.linear - b.linear).norm(), 1e-12) << k;
    EXPECT_LE((a.angular - b.angular).norm(), 1e-12) << k;
  }
}

TEST(ReducedModel, GivesTheVelocitiesOfTheFullModel) {
  Yard yard(3);
  yard.state[1].x.z() += 0.005;  // a box that is apart from the plane, and falls
  yard.state[3].x.z() += 0.007;
  yard.state[3].p.z() = 1.0;
  StepReport report;
  expect_same_velocities(yard.bodies, yard.state, yard.finder.back(), report);
  EXPECT_GT(report.contacts_apart, 0);
}

TEST(ReducedModel, PutsBackWhatTheSolveWouldClose) {
  // Ball 1 runs into ball 2, which touches it; ball 3 is 1 mm behind: apart until 2 is hit.
  const Bodies bodies{fixed_body(), ball_body(1, 0.5), ball_body(1, 0.5), ball_body(1, 0.5)};
  PlaneContacts finder(
      Vec3::UnitZ(),
      {{TestBall{0.5}, {0.0, 0.0}}, {TestBall{0.5}, {0.0, 0.0}}, {TestBall{0.5}, {0.0, 0.0}}});
  finder.without_plane();
  finder.pair_balls(1, 2);
  finder.pair_balls(2, 3);
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 5)), at(Vec3(1, 0, 5)), at(Vec3(2.001, 0, 5))};
  state[1].p = Vec3(10, 0, 0);
  StepReport report;
  expect_same_velocities(bodies, state, finder, report);
  EXPECT_EQ(report.contacts_put_back, 1);
  EXPECT_EQ(report.contacts_apart, 0);
  EXPECT_EQ(report.contacts.size(), 2u);
}

/// A heap of smooth balls, a smooth box that two of them lean on, and apart a ball with friction.
struct SmoothHeap {
  Bodies bodies{fixed_body()};
  State state{at(Vec3::Zero())};
  std::vector<TestBody> shapes;
  PlaneContacts finder = fill();

  PlaneContacts fill() {
    const auto add = [&](const Body& body, const Vec3& x, const TestBody& shape) {
      bodies.push_back(body);
      state.push_back(at(x));
      shapes.push_back(shape);
    };
    const double high = 0.5 + std::sqrt(2.0) / 2.0;
    for (const double x : {0.0, 1.0}) {
      for (const double y : {0.0, 1.0}) {
        add(ball_body(1.0 + x, 0.5), Vec3(x, y, 0.5), {TestBall{0.5}, {0.0, 0.0}});
      }
    }
    add(ball_body(7.0, 0.5), Vec3(0.5, 0.5, high), {TestBall{0.5}, {0.0, 0.0}});
    add(ball_body(1.0, 0.5), Vec3(9.0, 0.0, 0.5), {TestBall{0.5}, {0.4, 0.0}});
    add(box_body(1.0, kHalf), Vec3(0.0, 9.0, 0.2), {TestBox{kHalf}, {0.0, 0.0}});
    state[1].L = Vec3(0.3, -0.2, 0.5);  // spins on
    state[6].L = Vec3(0.0, 0.4, 0.0);   // is braked
    PlaneContacts made(Vec3::UnitZ(), shapes);
    for (int k = 1; k <= 4; ++k) {
      made.pair_balls(5, k);
    }
    return made;
  }
};

TEST(ReducedModel, HasNoColumnsOfRotationsThatNothingCanTurn) {
  SmoothHeap heap;
  StepReport report;
  expect_same_velocities(heap.bodies, heap.state, heap.finder, report);
  ASSERT_EQ(report.islands.size(), 3u);
  EXPECT_EQ(report.islands[0].bodies, 5);
  EXPECT_EQ(report.islands[0].columns, 15);
  EXPECT_EQ(report.islands[1].columns, 6);  // friction turns it
  EXPECT_EQ(report.islands[2].columns, 6);  // corners do
  EXPECT_EQ(report.rotations_left_out, 5);
  EXPECT_NE(to_text(report).find("5 rotations of bodies that nothing can turn"), std::string::npos);
}

TEST(ReducedModel, AFaintLeverKeepsItsColumns) {
  // The centre of mass is off the line of the normal: little, but more than rounding tells.
  for (const double lever : {0.0, 1e-12, 1e-5}) {
    SmoothHeap heap;
    ContactSet contacts;
    heap.finder.find(heap.state, 0.01, contacts);
    contacts.resize(1);
    contacts[0].point_a += Vec3(lever, 0.0, 0.0);
    NormalRows rows;
    assemble_normals(heap.bodies, heap.state, contacts, rows, {}, BodyColumns::kThatForcesReach);
    EXPECT_EQ(rows.A.degrees_of_freedom(), lever > 1e-8 ? 6 : 3) << lever;
    rows.A.clear();
    assemble_normals(heap.bodies, heap.state, contacts, rows, {{1, 2}},
                     BodyColumns::kThatForcesReach);
    EXPECT_EQ(rows.A.degrees_of_freedom(), 12);  // joined
  }
}

TEST(ReducedModel, ALooseStackTakesThreeSolvesNotOneABox) {
  // Ten boxes 1e-5 m apart: all fall alike, so no contact but the lowest closes freely.
  class Count final : public lcp::SolveRecorder {
   public:
    std::string record(const lcp::SolveRecord&) override {
      ++solves;
      return {};
    }
    int solves = 0;
  } count;
  constexpr int kBoxes = 10;
  Bodies bodies{fixed_body()};
  State state{at(Vec3::Zero())};
  std::vector<testing_tools::TestBody> shapes;
  for (int k = 0; k < kBoxes; ++k) {
    bodies.push_back(box_body(1.0, kHalf));
    state.push_back(at(Vec3(0.0, 0.0, 0.2 + (0.4 + 1e-5) * k)));
    shapes.push_back({TestBox{kHalf}, {0.4, 0.0}});
  }
  PlaneContacts finder(Vec3::UnitZ(), shapes);
  for (int k = 2; k <= kBoxes; ++k) {
    finder.stack(k, k - 1);
  }
  StepReport report;
  expect_same_velocities(bodies, state, finder, report);
  EXPECT_EQ(report.contacts_put_back, 4 * (kBoxes - 1));
  TimeStepSettings settings = dial(Accuracy::engineering());
  settings.lcp.recorder = &count;
  TimeStepper stepper(bodies, finder, settings);
  stepper.step(state, report);
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_LE(count.solves, 3 + 1);  // the projection's too
}

TEST(ReducedModel, AThousandBodiesApartAddNoRowNoWorkAndNoAllocation) {
  std::vector<std::pair<long, StepReport>> runs;
  for (const int extra : {0, 1000}) {
    Yard yard(2);
    for (int k = 0; k < extra; ++k) {
      yard.bodies.push_back(ball_body(1.0, 0.5));
      yard.state.push_back(at(Vec3(2.0 * k, 50.0, 20.0)));
    }
    // The finder of the yard knows nothing of the extra bodies: they are far from everything.
    class Near final : public ContactFinder {
     public:
      Near(PlaneContacts& inner, std::size_t bodies) : inner_(inner), bodies_(bodies) {}
      void find(const State& state, double margin, ContactSet& contacts) override {
        near_.assign(state.begin(), state.begin() + static_cast<std::ptrdiff_t>(bodies_));
        inner_.find(near_, margin, contacts);
      }
      [[nodiscard]] std::optional<FirstContact> first_contact(std::span<const Motion* const> m,
                                                              double t,
                                                              RestingPairs resting) override {
        return inner_.first_contact(m, t, resting);
      }

     private:
      PlaneContacts& inner_;
      std::size_t bodies_;
      State near_;
    } finder(yard.finder.back(), 8);
    TimeStepper stepper(yard.bodies, finder, dial(Accuracy::engineering()));
    StepReport report;
    for (int k = 0; k < 20; ++k) {
      stepper.step(yard.state, report);
    }
    const lcp::AllocationCount allocations;
    stepper.step(yard.state, report);
    runs.emplace_back(allocations.count(), report);
  }
  EXPECT_EQ(runs[0].first, runs[1].first);
  const StepReport& few = runs[0].second;
  const StepReport& many = runs[1].second;
  EXPECT_EQ(few.rows, many.rows);
  EXPECT_EQ(few.islands.size(), many.islands.size());
  EXPECT_EQ(few.work, many.work);
  EXPECT_EQ(few.result.statistics.factorizations, many.result.statistics.factorizations);
  EXPECT_EQ(many.dynamic_bodies_without_rows, few.dynamic_bodies_without_rows + 1000);
}

}  // namespace
}  // namespace signorini
