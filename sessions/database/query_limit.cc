#include "sessions/database/query_limit.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/progress.h"
#include "sessions/database/damage.h"

namespace elbowroom::sessions {
namespace {

constexpr int kStepsBetweenQuestions = 4096;
// kStepsOfAnyFile take about a second on any machine in use. kStepsPerByte is ten times what the most
// expensive statement of a sound session takes.
constexpr std::int64_t kStepsOfAnyFile = 20'000'000;
constexpr std::int64_t kStepsPerByte = 10;

}  // namespace

std::int64_t MostStepsFor(std::int64_t file_bytes) { return kStepsOfAnyFile + kStepsPerByte * file_bytes; }

struct QueryLimit::Count {
  sqlite3* connection = nullptr;
  std::string path;
  std::stop_token stop;
  std::int64_t most = 0;
  std::int64_t taken = 0;  // by the statement that began last
  std::int64_t most_taken = 0;
  bool is_exceeded = false;

  static int Ask(void* self) {
    auto& count = *static_cast<Count*>(self);
    count.taken += kStepsBetweenQuestions;
    count.most_taken = std::max(count.most_taken, count.taken);
    count.is_exceeded = count.is_exceeded || count.taken > count.most;
    return count.is_exceeded || count.stop.stop_requested() ? 1 : 0;
  }
  // A statement that begins while another's rows are being read counts as part of that one.
  static int Begin(unsigned /*what*/, void* self, void* statement, void* /*sql*/) {
    auto& count = *static_cast<Count*>(self);
    for (auto* other = sqlite3_next_stmt(count.connection, nullptr); other != nullptr;
         other = sqlite3_next_stmt(count.connection, other)) {
      if (other != statement && sqlite3_stmt_busy(other) != 0) return 0;
    }
    count.taken = 0;
    return 0;
  }

  ~Count() {
    sqlite3_progress_handler(connection, 0, nullptr, nullptr);
    sqlite3_trace_v2(connection, 0, nullptr, nullptr);
  }
};

QueryLimit::QueryLimit(Database& database, std::stop_token stop) : count_(std::make_unique<Count>()) {
  count_->connection = database.connection().getHandle();
  count_->path = database.path().string();
  count_->stop = std::move(stop);
  count_->most =
      MostStepsFor(database.ReadInteger("PRAGMA page_count") * database.ReadInteger("PRAGMA page_size"));
  sqlite3_progress_handler(count_->connection, kStepsBetweenQuestions, &Count::Ask, count_.get());
  sqlite3_trace_v2(count_->connection, SQLITE_TRACE_STMT, &Count::Begin, count_.get());
}

QueryLimit::~QueryLimit() = default;
QueryLimit::QueryLimit(QueryLimit&&) noexcept = default;
QueryLimit& QueryLimit::operator=(QueryLimit&&) noexcept = default;

void QueryLimit::ThrowIfEnded() const {
  if (count_->is_exceeded) {
    FailAsDamaged(fmt::format("session '{}'", count_->path),
                  fmt::format("a question to it took more than {} million steps, which no sound file of its "
                              "size needs",
                              count_->most / 1'000'000));
  }
  core::ThrowIfStopped(count_->stop, fmt::format("reading session '{}'", count_->path));
}

std::int64_t QueryLimit::most_steps_taken() const { return count_->most_taken; }

}  // namespace elbowroom::sessions
