#include "tools/job_files.h"

#include "tools/byte_archive.h"
#include "tools/file_state.h"
#include "tools/whole_file.h"

#include <cctype>
#include <cstdint>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace signorini::tools {
namespace {

/// FNV-1a of 64 bits: tells files apart that differ by chance, not by intent.
std::uint64_t print_of(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char byte : bytes) {
    hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
  }
  return hash;
}

std::optional<std::string> read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  if (!file || !(bytes << file.rdbuf())) {
    return std::nullopt;
  }
  return bytes.str();
}

/// What a file holds.
struct KeptJob {
  std::string key;
  std::string name;
  std::string bytes;
  int at_once = 0;
  std::uint64_t print = 0;  ///< of the bytes
};

void visit_fields(auto& archive, Reflects<KeptJob> auto& kept) {
  archive(kept.key, kept.name, kept.bytes, kept.at_once, kept.print);
}

}  // namespace

std::filesystem::path job_file(const std::filesystem::path& folder, const Job& job) {
  std::string name;
  for (const char character : job.name.substr(0, 60)) {
    name += std::isalnum(static_cast<unsigned char>(character)) != 0 ? character : '-';
  }
  return folder / fmt::format("{}-{:08x}.job", name, print_of(job.name) >> 32U);
}

JobFiles::JobFiles(std::filesystem::path folder, const std::string& settings)
    : folder_(std::move(folder)) {
  if (folder_.empty()) {
    return;
  }
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("cannot make the folder {}: {}", folder_.string(), error.message()));
  }
  const std::optional<std::string> program = read_file("/proc/self/exe");
  key_ =
      fmt::format("{:016x}\n{}\n{}", program ? print_of(*program) : 0, library_states(), settings);
}

std::optional<JobResult> JobFiles::find(const Job& job) const {
  if (folder_.empty()) {
    return std::nullopt;
  }
  const std::optional<std::string> bytes = read_file(job_file(folder_, job));
  if (!bytes) {
    return std::nullopt;
  }
  try {
    auto kept = from_bytes<KeptJob>(*bytes);
    if (kept.key != key_ || kept.name != job.name || kept.print != print_of(kept.bytes)) {
      return std::nullopt;
    }
    return JobResult{
        .is_done = true, .bytes = std::move(kept.bytes), .reason = {}, .at_once = kept.at_once};
  } catch (const std::runtime_error&) {  // cut off, or no such file at all
    return std::nullopt;
  }
}

void JobFiles::keep(const Job& job, const JobResult& result) const {
  if (folder_.empty()) {
    return;
  }
  write_whole_file(job_file(folder_, job), to_bytes(KeptJob{.key = key_,
                                                            .name = job.name,
                                                            .bytes = result.bytes,
                                                            .at_once = result.at_once,
                                                            .print = print_of(result.bytes)}));
}

void forget_finished_jobs(const std::vector<Job>& jobs, const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const Job& job : jobs) {
    std::filesystem::remove(job_file(folder, job), ignored);
  }
  std::filesystem::remove(folder, ignored);  // not if anything is left in it
}

}  // namespace signorini::tools
