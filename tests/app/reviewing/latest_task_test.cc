#include "app/control/reviewing/latest_task.h"

#include <gtest/gtest.h>

#include <semaphore>
#include <vector>

namespace elbowroom::control {
namespace {

TEST(LatestTask, GivesUpWhatWaitsForWhatIsAskedLast) {
  std::vector<int> done;
  std::binary_semaphore began(0), go_on(0), end(0);
  LatestTask thread;
  thread.AfterThis([&](const std::stop_token& stop) {
    began.release();
    go_on.acquire();
    done.push_back(stop.stop_requested() ? -1 : 1);
  });
  began.acquire();
  thread.AfterThis([&](const std::stop_token&) { done.push_back(2); });
  thread.AfterThis([&](const std::stop_token&) {
    done.push_back(3);
    end.release();
  });
  go_on.release();
  end.acquire();
  EXPECT_EQ(done, (std::vector{1, 3}));
}

TEST(LatestTask, StopsWhatRunsForWhatIsAskedInstead) {
  std::vector<int> done;
  std::binary_semaphore began(0), go_on(0), end(0);
  LatestTask thread;
  thread.AfterThis([&](const std::stop_token& stop) {
    began.release();
    go_on.acquire();
    done.push_back(stop.stop_requested() ? -1 : 1);
  });
  began.acquire();
  thread.InsteadOfThis([&](const std::stop_token& stop) {
    done.push_back(stop.stop_requested() ? -2 : 2);
    end.release();
  });
  go_on.release();
  end.acquire();
  EXPECT_EQ(done, (std::vector{-1, 2}));
}

TEST(LatestTask, EndsWithoutWhatWaits) {
  std::vector<int> done;
  std::binary_semaphore began(0);
  {
    LatestTask thread;
    thread.AfterThis([&](const std::stop_token& stop) {
      began.release();
      while (!stop.stop_requested()) std::this_thread::yield();
      done.push_back(1);
    });
    began.acquire();
    thread.AfterThis([&](const std::stop_token&) { done.push_back(2); });
  }
  EXPECT_EQ(done, std::vector{1});
}

}  // namespace
}  // namespace elbowroom::control
