#include "base/long_work.h"

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/catch.h"

using namespace glidelab::base;

TEST_CASE("Every piece of work is done once, on no more threads than asked for") {
  for (const int jobs : {-1, 1, 2, 7}) {
    std::vector<std::atomic<int>> done(100);
    std::atomic<int> at_work{0};
    std::atomic<int> most{0};
    for_each_parallel(done.size(), jobs, [&](std::size_t i) {
      const int now = ++at_work;
      for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
      }
      ++done[i];
      --at_work;
    });
    for (const std::atomic<int>& count : done) CHECK(count == 1);
    CHECK(most <= std::max(jobs, 1));
  }
  for_each_parallel(0, 3, [](std::size_t) { FAIL("there is nothing to do"); });
}

TEST_CASE("Of several failures the one of the smallest piece comes out") {
  std::atomic<bool> second_failed{false};
  const auto work = [&](std::size_t i) {
    while (i == 0 && !second_failed) std::this_thread::yield();
    if (i == 1) second_failed = true;
    throw std::runtime_error(std::to_string(i));
  };
  CHECK_THROWS_WITH(for_each_parallel(50, 2, work), "0");
}

TEST_CASE("After a failure nothing new is begun") {
  // The other thread needs a second for all the pieces that are left; the failure is known long before.
  std::atomic<int> begun{0};
  const auto work = [&](std::size_t i) {
    ++begun;
    if (i == 1) throw std::runtime_error("stop");
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  };
  CHECK_THROWS_WITH(for_each_parallel(100, 2, work), "stop");
  CHECK(begun < 100);
}

TEST_CASE("A worker keeps what it has of its own over all its pieces") {
  std::atomic<int> made{0};
  std::atomic<std::size_t> sum{0};
  in_parallel(3, 1000, [&](const auto& next) {
    ++made;
    for (std::size_t i = next(); i < 1000; i = next()) sum += i;
  });
  CHECK(sum == 999u * 1000u / 2u);
  CHECK(made <= 3);
}
