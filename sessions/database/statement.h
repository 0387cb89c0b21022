// One prepared SQL statement: bind in order, run, read the columns of a row.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sessions/database/database.h"

namespace SQLite {
class Column;
class Statement;
}  // namespace SQLite

namespace elbowroom::sessions {

// A member that fails throws core::Error{kDatabase} naming the file. The database must outlive the statement.
// A column that may be NULL is tested with IsNull() before it is read. Reading throws Error{kFormat} naming
// the column where it is NULL, or holds a number that isn't finite or a text longer than kLongestText.
inline constexpr std::size_t kLongestText = 1 << 20;  // bytes; the program writes far shorter ones

class Statement {
 public:
  Statement(Database& database, const std::string& sql);
  Statement(Statement&&) noexcept;
  ~Statement();

  // Starts afresh with `values` bound to the statement's parameters, in order: integers, doubles, text,
  // bytes, optionals (nothing is NULL), and 3-vectors, which take three parameters.
  template <typename... Values>
  Statement& With(const Values&... values) {
    Restart();
    (Bind(values), ...);
    return *this;
  }

  void Run();                 // to its end
  [[nodiscard]] bool Next();  // true while there is a row

  // Columns of the current row, counted from 0.
  [[nodiscard]] bool IsNull(int column) const;
  [[nodiscard]] std::int64_t Integer(int column) const;
  [[nodiscard]] double Real(int column) const;
  [[nodiscard]] std::string Text(int column) const;  // valid UTF-8, with U+FFFD for what isn't
  [[nodiscard]] std::span<const std::byte> Bytes(int column) const;  // valid until Next() or With()
  [[nodiscard]] Eigen::Vector3d Vector(int first_column) const;      // three columns

 private:
  void Restart();
  [[nodiscard]] SQLite::Column Value(int column) const;
  [[noreturn]] void FailAtColumn(int column, std::string_view what) const;
  void BindInteger(std::int64_t value);
  void Bind(double value);
  void Bind(std::string_view text);
  void Bind(std::span<const std::byte> bytes);  // must stay alive until Run() or the last Next()
  void Bind(std::nullopt_t null);
  void Bind(const Eigen::Vector3d& vector);
  template <std::integral Integer>
  void Bind(Integer value) {
    BindInteger(static_cast<std::int64_t>(value));
  }
  template <typename Value>
  void Bind(const std::optional<Value>& value) {
    value ? Bind(*value) : Bind(std::nullopt);
  }
  void Bind(const std::optional<Eigen::Vector3d>& vector);

  std::filesystem::path path_;
  std::unique_ptr<SQLite::Statement> statement_;
  int bound_ = 0;
};

}  // namespace elbowroom::sessions
