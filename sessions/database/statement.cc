#include "sessions/database/statement.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include <cmath>

#include "sessions/database/damage.h"

namespace elbowroom::sessions {
namespace {

template <typename Work>
auto Translated(const std::filesystem::path& path, Work&& work) {
  try {
    return work();
  } catch (...) {
    RethrowAsError(path);
  }
}

}  // namespace

Statement::Statement(Database& database, const std::string& sql) : path_(database.path()) {
  Translated(path_, [&] { statement_ = std::make_unique<SQLite::Statement>(database.connection(), sql); });
}
Statement::Statement(Statement&&) noexcept = default;
Statement::~Statement() = default;

void Statement::Restart() {
  bound_ = 0;
  statement_->tryReset();  // returns an earlier failure again, which was thrown when it happened
}

void Statement::BindInteger(std::int64_t value) {
  Translated(path_, [&] { statement_->bind(++bound_, value); });
}
void Statement::Bind(double value) {
  Translated(path_, [&] { statement_->bind(++bound_, value); });
}
void Statement::Bind(std::string_view text) {
  Translated(path_, [&] { statement_->bind(++bound_, std::string(text)); });
}
void Statement::Bind(std::span<const std::byte> bytes) {
  Translated(path_, [&] { statement_->bindNoCopy(++bound_, bytes.data(), static_cast<int>(bytes.size())); });
}
void Statement::Bind(std::nullopt_t) {
  Translated(path_, [&] { statement_->bind(++bound_); });
}
void Statement::Bind(const Eigen::Vector3d& vector) {
  for (const double value : vector) Bind(value);
}
void Statement::Bind(const std::optional<Eigen::Vector3d>& vector) {
  for (Eigen::Index i = 0; i < 3; ++i) vector ? Bind((*vector)[i]) : Bind(std::nullopt);
}

void Statement::Run() {
  Translated(path_, [&] {
    while (statement_->executeStep()) continue;
  });
}
bool Statement::Next() {
  return Translated(path_, [&] { return statement_->executeStep(); });
}

SQLite::Column Statement::Value(int column) const {
  SQLite::Column value = statement_->getColumn(column);
  if (value.isNull()) FailAtColumn(column, "nothing");
  return value;
}
void Statement::FailAtColumn(int column, std::string_view what) const {
  FailAsDamaged(fmt::format("session '{}'", path_.string()),
                fmt::format("column {} holds {}", Quotable(statement_->getColumnName(column)), what));
}

bool Statement::IsNull(int column) const {
  return Translated(path_, [&] { return statement_->isColumnNull(column); });
}
std::int64_t Statement::Integer(int column) const {
  return Translated(path_, [&] { return Value(column).getInt64(); });
}
double Statement::Real(int column) const {
  const double number = Translated(path_, [&] { return Value(column).getDouble(); });
  if (!std::isfinite(number)) FailAtColumn(column, "no finite number");
  return number;
}
std::string Statement::Text(int column) const {
  return Translated(path_, [&] {
    const SQLite::Column value = Value(column);
    if (value.getBytes() < 0 || static_cast<std::size_t>(value.getBytes()) > kLongestText)
      FailAtColumn(column, fmt::format("a text of {} bytes", value.getBytes()));
    return AsUtf8(value.getString());
  });
}
std::span<const std::byte> Statement::Bytes(int column) const {
  return Translated(path_, [&] {
    const SQLite::Column value = Value(column);
    const auto* first = static_cast<const std::byte*>(value.getBlob());
    return std::span<const std::byte>(first, static_cast<std::size_t>(value.getBytes()));
  });
}
Eigen::Vector3d Statement::Vector(int first_column) const {
  return {Real(first_column), Real(first_column + 1), Real(first_column + 2)};
}

}  // namespace elbowroom::sessions
