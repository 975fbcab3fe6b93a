#include <gtest/gtest.h>

#include <varifold/base/parallel.h>
#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace varifold {
namespace {

TEST(ParallelFor, VisitsEverythingOnce) {
  for (const int threads : {0, 1, 2, 3, 8})
    for (const std::size_t count : {0u, 1u, 7u, 1000u})
      for (const std::size_t grain : {0u, 1u, 7u, 5000u}) {
        std::vector<std::atomic<int>> visits(count);
        parallel_for(threads, count, grain, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) ++visits[i];
        });
        for (const auto& n : visits) ASSERT_EQ(n, 1);
      }
}

TEST(ParallelFor, PiecesDependOnTheGrainAlone) {
  const std::set<std::pair<std::size_t, std::size_t>> expected{{0, 4}, {4, 8}, {8, 10}};
  for (const int threads : {1, 2, 3}) {
    std::set<std::pair<std::size_t, std::size_t>> pieces;
    std::mutex mutex;
    parallel_for(threads, 10, 4, [&](std::size_t begin, std::size_t end) {
      const std::lock_guard lock(mutex);
      pieces.emplace(begin, end);
    });
    EXPECT_EQ(pieces, expected);
  }
}

TEST(ParallelFor, OneThreadGoesInOrder) {
  std::vector<std::size_t> order;
  parallel_for(1, 10, 3, [&](std::size_t begin, std::size_t) { order.push_back(begin); });
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 3, 6, 9}));
}

TEST(ParallelBoth, RunsBothAndLoopsWithin) {
  for (const int threads : {0, 1, 2, 3, 8}) {
    std::vector<std::atomic<int>> visits(200);
    const auto visit = [&](std::size_t first) {
      parallel_for(threads, 100, 3, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++visits[first + i];
      });
    };
    std::thread::id first;
    parallel_both(
        threads,
        [&] {
          visit(0);
          first = std::this_thread::get_id();
        },
        [&] { visit(100); });
    for (const auto& n : visits) ASSERT_EQ(n, 1);
    EXPECT_EQ(first, std::this_thread::get_id());
  }
}

TEST(ParallelBoth, LeavesNothingRunningWhereOneThrows) {
  for (int i = 0; i < 20; ++i) {
    std::atomic<int> begun = 0, ended = 0;
    const auto slow = [&] {
      ++begun;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ++ended;
    };
    const auto throws = [&] {
      if (i % 2 == 0) std::this_thread::sleep_for(std::chrono::microseconds(500));
      throw std::runtime_error("one");
    };
    EXPECT_THROW(parallel_both(2, throws, slow), std::runtime_error);
    EXPECT_EQ(begun, ended);
  }
}

TEST(HardwareThreads, AtLeastOne) { EXPECT_GE(hardware_threads(), 1); }

}  // namespace
}  // namespace varifold
