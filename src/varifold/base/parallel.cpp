#include <varifold/base/parallel.h>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <algorithm>
#include <optional>

#if defined(__SANITIZE_THREAD__)
#define VARIFOLD_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define VARIFOLD_THREAD_SANITIZER 1
#endif
#endif

#ifdef VARIFOLD_THREAD_SANITIZER
#include <atomic>
#include <thread>
#include <vector>
#endif

namespace varifold {

namespace {

#ifdef VARIFOLD_THREAD_SANITIZER

// The sanitizer cannot see how the system's oneTBB synchronises; plain threads it can.

template <class Piece>
void run_pieces(int threads, std::size_t count, const Piece& piece) {
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> workers;
  for (int i = 0; i < threads; ++i)
    workers.emplace_back([&] {
      for (std::size_t p = next++; p < count; p = next++) piece(p);
    });
  for (std::thread& worker : workers) worker.join();
}

void run_both(int, const std::function<void()>& first, const std::function<void()>& second) {
  const std::jthread worker(second);  // joins, also when first() throws
  first();
}

#else

/// Runs body() in an arena of so many threads.
template <class Body>
void run_in_arena(int threads, const Body& body) {
  // Within another loop the same arena serves both, so that whoever is done helps the other.
  if (tbb::this_task_arena::max_concurrency() == threads) return body();
  // oneTBB caps its workers at the hardware's; more are given where they are asked for.
  std::optional<tbb::global_control> raised;
  if (threads > hardware_threads())
    raised.emplace(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(threads);
  arena.execute(body);
}

/// Runs piece(0) .. piece(count - 1) on the pool.
template <class Piece>
void run_pieces(int threads, std::size_t count, const Piece& piece) {
  run_in_arena(threads, [&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t p = range.begin(); p < range.end(); ++p) piece(p);
        },
        tbb::simple_partitioner());
  });
}

void run_both(int threads, const std::function<void()>& first,
              const std::function<void()>& second) {
  run_in_arena(threads, [&] {
    tbb::task_group group;
    group.run(second);
    group.run_and_wait(first);  // on this thread; waits for both, also where one throws
  });
}

#endif

}  // namespace

int hardware_threads() { return std::max(1, tbb::info::default_concurrency()); }

void parallel_for(int threads, std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t pieces = (count + grain - 1) / grain;
  if (threads <= 0) threads = hardware_threads();
  if (threads == 1 || pieces <= 1) {
    for (std::size_t i = 0; i < pieces; ++i) body(i * grain, std::min(count, (i + 1) * grain));
    return;
  }
  run_pieces(threads, pieces,
             [&](std::size_t i) { body(i * grain, std::min(count, (i + 1) * grain)); });
}

void parallel_both(int threads, const std::function<void()>& first,
                   const std::function<void()>& second) {
  if (threads <= 0) threads = hardware_threads();
  if (threads > 1) return run_both(threads, first, second);
  first();
  second();
}

}  // namespace varifold
