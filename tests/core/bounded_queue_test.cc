#include "core/bounded_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <thread>
#include <vector>

namespace elbowroom::core {
namespace {

TEST(BoundedQueue, KeepsTheOrder) {
  BoundedQueue<int> queue(3, WhenFull::kBlock);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(queue.Push(i));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(queue.Pop(), i);
  EXPECT_EQ(queue.TryPop(), std::nullopt);
}

TEST(BoundedQueue, DropOldestKeepsTheLatestAndCounts) {
  BoundedQueue<int> queue(2, WhenFull::kDropOldest);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(queue.Push(i));
  EXPECT_EQ(queue.dropped(), 3U);
  EXPECT_EQ(queue.Pop(), 3);
  EXPECT_EQ(queue.Pop(), 4);
}

TEST(BoundedQueue, WhatIsPushedIfEmptyReplacesNothing) {
  BoundedQueue<int> queue(1, WhenFull::kDropOldest);
  EXPECT_TRUE(queue.PushIfEmpty(1));
  EXPECT_FALSE(queue.PushIfEmpty(2));
  EXPECT_TRUE(queue.Push(3));
  EXPECT_EQ(queue.dropped(), 1U);
  EXPECT_FALSE(queue.PushIfEmpty(4));
  EXPECT_EQ(queue.Pop(), 3);
  queue.Close();
  EXPECT_FALSE(queue.PushIfEmpty(5));
  EXPECT_EQ(queue.TryPop(), std::nullopt);
}

TEST(BoundedQueue, PushIfRoomNeverWaits) {
  BoundedQueue<int> queue(2, WhenFull::kBlock);
  EXPECT_TRUE(queue.PushIfRoom(1));
  EXPECT_TRUE(queue.PushIfRoom(2));
  EXPECT_FALSE(queue.PushIfRoom(3));
  EXPECT_EQ(queue.Pop(), 1);
  EXPECT_TRUE(queue.PushIfRoom(4));
  queue.Close();
  EXPECT_EQ(queue.Pop(), 2);
  EXPECT_FALSE(queue.PushIfRoom(5));
  EXPECT_EQ(queue.Pop(), 4);
}

TEST(BoundedQueue, ClosedTakesNothingInButGivesWhatIsInside) {
  BoundedQueue<int> queue(2, WhenFull::kBlock);
  EXPECT_TRUE(queue.Push(1));
  queue.Close();
  EXPECT_FALSE(queue.Push(2));
  EXPECT_EQ(queue.Pop(), 1);
  EXPECT_EQ(queue.Pop(), std::nullopt);
}

TEST(BoundedQueue, CloseWakesAWaitingConsumer) {
  BoundedQueue<int> queue(1, WhenFull::kBlock);
  auto popped = std::async(std::launch::async, [&] { return queue.Pop(); });
  queue.Close();
  EXPECT_EQ(popped.get(), std::nullopt);
}

TEST(BoundedQueue, CloseWakesAWaitingProducer) {
  BoundedQueue<int> queue(1, WhenFull::kBlock);
  EXPECT_TRUE(queue.Push(1));
  auto pushed = std::async(std::launch::async, [&] { return queue.Push(2); });
  queue.Close();
  EXPECT_FALSE(pushed.get());
  EXPECT_EQ(queue.dropped(), 0U);
}

TEST(BoundedQueue, BlockingLosesNothingAmongManyThreads) {
  constexpr int kProducers = 4, kConsumers = 3, kEach = 5000;
  BoundedQueue<int> queue(7, WhenFull::kBlock);
  std::atomic<std::int64_t> sum = 0, count = 0;
  std::vector<std::thread> consumers, producers;
  for (int c = 0; c < kConsumers; ++c) {
    consumers.emplace_back([&] {
      while (const auto value = queue.Pop()) sum += *value, ++count;
    });
  }
  for (int p = 0; p < kProducers; ++p) {
    producers.emplace_back([&, p] {
      for (int i = 0; i < kEach; ++i) EXPECT_TRUE(queue.Push(p * kEach + i));
    });
  }
  for (auto& producer : producers) producer.join();
  queue.Close();
  for (auto& consumer : consumers) consumer.join();
  constexpr std::int64_t kTotal = std::int64_t{kProducers} * kEach;
  EXPECT_EQ(count, kTotal);
  EXPECT_EQ(sum, kTotal * (kTotal - 1) / 2);
}

TEST(BoundedQueue, LatestWinsNeverBlocksAndTheLastValueArrives) {
  BoundedQueue<int> queue(1, WhenFull::kDropOldest);
  constexpr int kLast = 20'000;
  int last_seen = -1, seen = 0;
  std::thread consumer([&] {
    while (const auto value = queue.Pop()) {
      EXPECT_GT(*value, last_seen);
      last_seen = *value;
      ++seen;
    }
  });
  for (int i = 0; i <= kLast; ++i) EXPECT_TRUE(queue.Push(i));
  queue.Close();
  consumer.join();
  EXPECT_EQ(last_seen, kLast);
  EXPECT_EQ(queue.dropped() + static_cast<std::size_t>(seen), static_cast<std::size_t>(kLast) + 1);
}

TEST(BoundedQueue, CarriesValuesThatOnlyMove) {
  BoundedQueue<std::unique_ptr<int>> queue(1, WhenFull::kBlock);
  EXPECT_TRUE(queue.Push(std::make_unique<int>(5)));
  EXPECT_EQ(**queue.Pop(), 5);
}

TEST(BoundedQueue, HoldsAtLeastOneValue) {
  EXPECT_THROW(BoundedQueue<int>(0, WhenFull::kBlock), PreconditionError);
}

}  // namespace
}  // namespace elbowroom::core
