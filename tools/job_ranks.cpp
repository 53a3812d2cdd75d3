#include "tools/job_ranks.h"

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#ifdef SIGNORINI_HAS_MPI
#include <limits>
#include <mpi.h>
#include <poll.h>
#endif

namespace signorini::tools {
namespace {

/// The rank by the environment, null outside of MPI: Open MPI's mpirun; PMIx and PMI, as srun's.
const char* rank_by_environment() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"}) {
    if (const char* rank = std::getenv(name)) {
      return rank;
    }
  }
  return nullptr;
}

}  // namespace

bool is_under_mpi() {
  return rank_by_environment() != nullptr;
}

bool is_first_rank() {
  const char* rank = rank_by_environment();
  return rank == nullptr || std::atoi(rank) == 0;
}

#ifdef SIGNORINI_HAS_MPI

namespace {

constexpr int kJobTag = 1;     // to a rank: a job's number, or kNoMore
constexpr int kReportTag = 2;  // to the first rank
constexpr int kNoMore = -1;
constexpr int kGlanceMilliseconds = 2;  // MPI's own waiting would take a whole core

int size_of_message(const MPI_Status& status) {
  int count = 0;
  MPI_Get_count(&status, MPI_CHAR, &count);
  return count;
}

/// A message of this tag that has arrived.
std::optional<MPI_Status> arrived(int tag) {
  int is_there = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &is_there, &status);
  return is_there != 0 ? std::optional<MPI_Status>(status) : std::nullopt;
}

class MpiCrew final : public RankCrew {
 public:
  explicit MpiCrew(const std::vector<Job>& jobs) : worker_(jobs) {
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  ~MpiCrew() override {
    if (leads()) {
      send_everybody_home();
    }
    MPI_Finalize();
  }
  MpiCrew(const MpiCrew&) = delete;
  MpiCrew& operator=(const MpiCrew&) = delete;

  [[nodiscard]] bool leads() const override { return rank_ == 0; }
  [[nodiscard]] int hands() const override { return size_; }
  void give(int hand, int job) override {
    if (hand == 0) {
      worker_.give(job);
    } else {
      send_job(hand, job);
    }
  }
  [[nodiscard]] std::optional<Finished> wait() override {
    if (const auto status = arrived(kReportTag)) {
      return Finished{status->MPI_SOURCE, receive_report(*status)};
    }
    if (std::optional<JobReport> report = glance_at_worker()) {
      return Finished{0, std::move(*report)};
    }
    return std::nullopt;
  }
  void serve() override {
    try {
      serve_until_home();
    } catch (const std::exception& error) {
      // The first rank waits for this one, and MPI_Finalize() for all: nothing else ends them.
      std::fprintf(stderr, "rank %d: %s\n", rank_, error.what());
      MPI_Abort(MPI_COMM_WORLD, 1);
    }
  }

 private:
  void serve_until_home() {
    while (true) {
      if (arrived(kJobTag)) {
        int job = kNoMore;
        MPI_Recv(&job, 1, MPI_INT, 0, kJobTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        if (job == kNoMore) {
          send_report({.job = kNoMore});
          return;  // whatever the worker does ends with it
        }
        worker_.give(job);
      }
      if (const std::optional<JobReport> report = glance_at_worker()) {
        send_report(*report);
      }
    }
  }

  std::optional<JobReport> glance_at_worker() {
    pollfd end = {worker_.descriptor(), POLLIN, 0};
    if (::poll(&end, 1, kGlanceMilliseconds) <= 0) {
      return std::nullopt;
    }
    return worker_.take();
  }
  /// What they still had to say is dropped: a message must be received before MPI may end.
  void send_everybody_home() const {
    for (int rank = 1; rank < size_; ++rank) {
      send_job(rank, kNoMore);
    }
    for (int at_work = size_ - 1; at_work > 0;) {
      if (const auto status = arrived(kReportTag)) {
        at_work -= receive_report(*status).job == kNoMore ? 1 : 0;
      } else {
        ::poll(nullptr, 0, kGlanceMilliseconds);
      }
    }
  }
  static JobReport receive_report(const MPI_Status& status) {
    std::string bytes(static_cast<std::size_t>(size_of_message(status)), '\0');
    MPI_Recv(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, status.MPI_SOURCE, kReportTag,
             MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return from_bytes<JobReport>(bytes);
  }
  static void send_job(int rank, int job) {
    MPI_Send(&job, 1, MPI_INT, rank, kJobTag, MPI_COMM_WORLD);
  }
  static void send_report(const JobReport& report) {
    std::string bytes = to_bytes(report);
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
      bytes = to_bytes(JobReport{report.job, false, "its answer is too long for a message of MPI"});
    }
    MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, 0, kReportTag, MPI_COMM_WORLD);
  }

  JobWorker worker_;  // first: it is forked before MPI starts
  int rank_ = 0;
  int size_ = 1;
};

}  // namespace

std::unique_ptr<RankCrew> join_ranks(const std::vector<Job>& jobs) {
  return std::make_unique<MpiCrew>(jobs);
}

#else

std::unique_ptr<RankCrew> join_ranks(const std::vector<Job>&) {
  throw std::invalid_argument(
      "started as a rank of MPI, but this build is without MPI (SIGNORINI_WITH_MPI, "
      "libopenmpi-dev): "
      "every rank would do all jobs");
}

#endif

}  // namespace signorini::tools
