#include <varifold/base/parallel.h>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <algorithm>
#include <optional>

namespace varifold {

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
  // oneTBB caps its workers at the hardware's; more are given where they are asked for.
  std::optional<tbb::global_control> raised;
  if (threads > hardware_threads())
    raised.emplace(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, pieces, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i < range.end(); ++i)
            body(i * grain, std::min(count, (i + 1) * grain));
        },
        tbb::simple_partitioner());
  });
}

}  // namespace varifold
