#include "allocation_count.h"

#include <signorini/lcp/back_end.h>

#include <atomic>
#include <cerrno>
#include <cstddef>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
// Of <sanitizer/allocator_interface.h>, which g++ 12 does not install.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void*,
                                                                             std::size_t),
                                                         void (*free_hook)(const volatile void*));
#endif

namespace {
std::atomic<int> counters{0};  // that live
std::atomic<long> allocations{0};
std::atomic<long> back_end_allocations{0};
thread_local long allowed_allocations = -1;  // of this thread; < 0: any number

void count_one() {
  if (counters.load(std::memory_order_relaxed) == 0) {
    return;
  }
  ++(signorini::lcp::BackEndScope::is_active() ? back_end_allocations : allocations);
}

/// Counts one. @return false if there is to be no memory for it
[[maybe_unused]] bool may_allocate() {
  count_one();
  if (signorini::lcp::BackEndScope::is_active()) {
    return true;
  }
  if (allowed_allocations > 0) {
    --allowed_allocations;
    return true;
  }
  return allowed_allocations < 0;
}
}  // namespace

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
// The sanitizer owns malloc and offers a hook.
namespace {
const int hooked = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { count_one(); }, [](const volatile void*) {});
}  // namespace
#else
// glibc's own names behind malloc; ours stand before them for the whole process.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  return may_allocate() ? __libc_malloc(size) : nullptr;
}
void* calloc(std::size_t count, std::size_t size) {
  return may_allocate() ? __libc_calloc(count, size) : nullptr;
}
void* realloc(void* old, std::size_t size) {
  return may_allocate() ? __libc_realloc(old, size) : nullptr;
}
void* memalign(std::size_t alignment, std::size_t size) {
  return may_allocate() ? __libc_memalign(alignment, size) : nullptr;
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return may_allocate() ? __libc_memalign(alignment, size) : nullptr;
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  *out = may_allocate() ? __libc_memalign(alignment, size) : nullptr;
  return *out == nullptr ? ENOMEM : 0;
}
}
#endif

namespace signorini::lcp {

AllocationCount::AllocationCount()
    : at_start_(allocations.load()), back_end_at_start_(back_end_allocations.load()) {
  ++counters;
}

AllocationCount::~AllocationCount() {
  --counters;
}

long AllocationCount::count() const {
  return allocations.load() - at_start_;
}

long AllocationCount::back_end_count() const {
  return back_end_allocations.load() - back_end_at_start_;
}

NoMemoryAfter::NoMemoryAfter(long allowed) {
  allowed_allocations = allowed;
}

NoMemoryAfter::~NoMemoryAfter() {
  allowed_allocations = -1;
}

}  // namespace signorini::lcp
