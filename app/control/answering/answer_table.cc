#include "app/control/answering/answer_table.h"

#include <fmt/format.h>

#define CSV_IO_NO_THREAD  // the table is in memory
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wstringop-truncation"  // of file names in its messages, which aren't used
#include <libfccp/csv.h>
#pragma GCC diagnostic pop

#include "core/error.h"
#include "core/plain_text.h"
#include "core/system/configuration_file.h"

namespace elbowroom::control {
namespace {

using core::Error;
using core::ErrorKind;
template <unsigned columns>
using CsvReader = io::CSVReader<columns, io::trim_chars<' ', '\t'>, io::double_quote_escape<',', '"'>,
                                io::throw_on_overflow, io::empty_line_comment>;
using AnswerReader = CsvReader<9>;

constexpr const char* kTable = "table of answers";

// What the parser found wrong with the line at which it stands.
[[noreturn]] void FailAtLine(const std::string& file, unsigned line, const std::string& what) {
  throw Error(ErrorKind::kFormat, fmt::format("{}:{}: {}", file, line, what));
}

// All that the first line may name; which of it must be there was looked at before.
void ReadHeader(AnswerReader& reader, const std::string& file, const std::string& text) {
  constexpr const char* kColumns =
      "the first line names the columns: item, answer, and any of session, participant, condition, order, "
      "block, phase, questionnaire";
  try {
    CsvReader<2> required(file, text.data(), text.data() + text.size());
    required.read_header(io::ignore_extra_column, "item", "answer");
    reader.read_header(io::ignore_missing_column, "item", "answer", "session", "participant", "condition",
                       "order", "block", "phase", "questionnaire");
  } catch (const io::error::missing_column_in_header& fault) {
    FailAtLine(file, 1, fmt::format("has no column '{}'; {}", core::Blanked(fault.column_name), kColumns));
  } catch (const io::error::extra_column_in_header& fault) {
    FailAtLine(file, 1,
               fmt::format("no column is called '{}'; {}", core::Blanked(fault.column_name), kColumns));
  } catch (const io::error::duplicated_column_in_header& fault) {
    FailAtLine(file, 1,
               fmt::format("has the column '{}' twice; leave one out", core::Blanked(fault.column_name)));
  } catch (const io::error::base&) {
    FailAtLine(file, 1, fmt::format("isn't a table; {}", kColumns));
  }
}

bool ReadRow(AnswerReader& reader, const std::string& file, GivenAnswer* row) {
  try {
    return reader.read_row(row->item, row->answer, row->session, row->participant, row->condition, row->order,
                           row->block, row->phase, row->questionnaire);
  } catch (const io::error::too_few_columns&) {
    FailAtLine(file, reader.get_file_line(), "has fewer fields than the first line; fill it up with commas");
  } catch (const io::error::too_many_columns&) {
    FailAtLine(file, reader.get_file_line(),
               "has more fields than the first line; put texts with commas in quotes");
  } catch (const io::error::base&) {
    FailAtLine(file, reader.get_file_line(), "opens a quote and doesn't close it in the line; close it");
  }
}

}  // namespace

std::vector<GivenAnswer> ReadAnswerTable(const std::filesystem::path& csv) {
  const std::string file = csv.string();
  const std::string text = core::ReadConfiguration(csv, file, kTable);
  if (text.find('\0') != std::string::npos)
    throw Error(ErrorKind::kFormat,
                fmt::format("{}: isn't a text; save the {} as CSV in UTF-8", file, kTable));
  AnswerReader reader(file, text.data(), text.data() + text.size());
  ReadHeader(reader, file, text);
  std::vector<GivenAnswer> given;
  for (GivenAnswer row; ReadRow(reader, file, &row); row = {}) {
    row.where = fmt::format("{}:{}", file, reader.get_file_line());
    for (const std::string* field : {&row.item, &row.answer, &row.session, &row.participant, &row.condition,
                                     &row.order, &row.block, &row.phase, &row.questionnaire})
      if (!core::IsPlain(*field))
        FailAtLine(file, reader.get_file_line(),
                   "has control characters, or isn't UTF-8; save the table in UTF-8");
    if (row.item.empty()) FailAtLine(file, reader.get_file_line(), "names no item; fill it in");
    given.push_back(std::move(row));
  }
  if (given.empty()) throw Error(ErrorKind::kFormat, fmt::format("{}: has no answers; add lines", file));
  return given;
}

GivenAnswer ParseGivenAnswer(std::string_view text) {
  GivenAnswer given{fmt::format("--give {}", text)};
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size())
    throw Error(ErrorKind::kRange, fmt::format("--give {}: must be ITEM=ANSWER, as in sure=5", text));
  given.item = text.substr(0, equals);
  given.answer = text.substr(equals + 1);
  for (const char* phase : {"before", "after"})
    if (const std::string prefix = std::string(phase) + ":"; given.item.starts_with(prefix)) {
      given.phase = phase;
      given.item.erase(0, prefix.size());
      break;
    }
  return given;
}

}  // namespace elbowroom::control
