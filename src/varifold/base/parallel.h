// The thread pool facade (oneTBB behind it). Results never depend on the number of threads: work
// is cut into pieces whose number depends on the data alone.
#pragma once

#include <cstddef>
#include <functional>

namespace varifold {

/// The number of hardware threads; at least 1.
[[nodiscard]] int hardware_threads();

/// Runs body(begin, end) over [0, count) in pieces of at most `grain`, on at most `threads` threads
/// (0 = all). With one thread or one piece it runs on the caller's thread, in order.
void parallel_for(int threads, std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Runs first() and second(), at the same time where there are threads for both; first() on the
/// caller's thread, and before second() where there is one thread alone. Where first() throws,
/// second() has ended or never begins.
void parallel_both(int threads, const std::function<void()>& first,
                   const std::function<void()>& second);

}  // namespace varifold
