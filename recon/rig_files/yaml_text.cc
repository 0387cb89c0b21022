#include "recon/rig_files/yaml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <unordered_set>

#include "core/error.h"
#include "core/plain_text.h"

namespace elbowroom::recon {
namespace {

constexpr int kDeepest = 64;
constexpr std::size_t kMostValues = 200'000;
constexpr std::size_t kLongestKeyBytes = 256;

// ".Inf", "-.inf", ".NaN" as YAML has them.
std::optional<double> SpecialNumber(std::string_view text) {
  const bool is_negative = text.starts_with('-');
  if (is_negative || text.starts_with('+')) text.remove_prefix(1);
  if (text == ".inf" || text == ".Inf" || text == ".INF")
    return is_negative ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
  if (text == ".nan" || text == ".Nan" || text == ".NaN" || text == ".NAN")
    return std::numeric_limits<double>::quiet_NaN();
  return std::nullopt;
}

// The whole text as a number. One too large for a double is infinite, one too small is zero.
std::optional<double> NumberOf(std::string_view text) {
  if (const auto special = SpecialNumber(text)) return special;
  if (text.starts_with('+')) text.remove_prefix(1);
  const std::size_t first = text.starts_with('-') ? 1 : 0;
  if (text.size() <= first || (text[first] != '.' && (text[first] < '0' || text[first] > '9')))
    return std::nullopt;  // from_chars takes "inf", which is a word here
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (end != text.data() + text.size() || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) return std::strtod(std::string(text).c_str(), nullptr);
  return number;
}

bool IsInteger(std::string_view text, double number) {
  return text.find_first_of(".eEnN") == std::string_view::npos && std::isfinite(number) &&
         std::abs(number) <= std::numeric_limits<int>::max();
}

// A recursive descent through the text, a byte at a time. A column counts bytes from 0.
class YamlParser {
 public:
  YamlParser(std::string_view text, const std::string& who) : text_(text), who_(who) {}

  YamlNode Document(YamlHeader header) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
    const bool has_header = text_.starts_with("%YAML:1.") || text_.starts_with("%YAML 1.");
    if (!has_header && header == YamlHeader::kRequired) FailAsNoYaml("it must begin with '%YAML:1.0'");
    for (SkipSpace(); Peek() == '%'; SkipSpace()) SkipLine();
    if (text_.substr(at_).starts_with("---")) at_ += 3;
    SkipSpace();
    if (AtEnd()) FailAsNoYaml("it holds no key");
    YamlNode root = Value(Column(), 0);
    if (root.kind != YamlKind::kMap) FailAsNoYaml("it must hold key: value lines");
    SkipSpace();
    const std::string_view rest = text_.substr(at_);
    if (!rest.empty() && !rest.starts_with("...") && !rest.starts_with("---"))
      Fail("this can't follow what stands before; indent by spaces, keys of one map alike");
    return root;
  }

 private:
  [[noreturn]] void FailAsNoYaml(std::string_view why) const {
    throw core::Error(
        core::ErrorKind::kFormat,
        fmt::format("{}: is not an OpenCV YAML file: {}; check that it is the right file, whole", who_, why));
  }
  [[noreturn]] void Fail(const std::string& what) const {
    throw core::Error(core::ErrorKind::kFormat, fmt::format("{}, line {}: {}", who_, line_, what));
  }

  [[nodiscard]] bool AtEnd() const { return at_ >= text_.size(); }
  [[nodiscard]] char Peek(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\n';
  }
  [[nodiscard]] int Column() const { return static_cast<int>(at_ - line_begin_); }
  [[nodiscard]] static bool IsBreak(char c) { return c == '\n' || c == '\r'; }
  [[nodiscard]] static bool EndsWord(char c) { return c == ' ' || IsBreak(c); }

  void SkipLine() {
    while (!AtEnd() && Peek() != '\n') ++at_;
  }
  // Spaces, line breaks and comments.
  void SkipSpace() {
    for (; !AtEnd(); ++at_) {
      if (Peek() == '#') SkipLine();
      if (AtEnd()) return;
      if (Peek() == '\n') {
        ++line_;
        line_begin_ = at_ + 1;
      } else if (Peek() == '\t' && flow_depth_ == 0) {
        Fail("a tab; indent by spaces");
      } else if (Peek() != ' ' && Peek() != '\r' && Peek() != '\t') {
        return;
      }
    }
  }

  // Reads a value that begins here, in a block: all of it stands at `column` or farther right.
  YamlNode Value(int column, int depth) {
    YamlNode node = Begin(depth);
    const bool is_text = SkipTag();
    if (AtEnd() || Column() < column) return node;
    const char c = Peek();
    if (c == '[' || c == '{') {
      Flow(node, depth);
    } else if (c == '-' && IsListMark()) {
      BlockList(node, depth);
    } else if (!is_text && IsKey()) {
      BlockMap(node, depth);
    } else {
      Scalar(node, false, is_text);
    }
    return node;
  }

  YamlNode Begin(int depth) {
    if (depth > kDeepest)
      Fail(fmt::format("nested more than {} deep; remove what doesn't belong here", kDeepest));
    if (++values_ > kMostValues)
      Fail(fmt::format("more than {} values; check that it is the right file", kMostValues));
    YamlNode node;
    node.line = line_;
    return node;
  }

  // Skips a tag such as "!!opencv-matrix" and the space after it. True if the tag says that a text follows.
  bool SkipTag() {
    if (Peek() != '!') return false;
    const std::size_t begin = at_;
    while (!AtEnd() && !EndsWord(Peek())) ++at_;
    const std::string_view tag = text_.substr(begin, at_ - begin);
    if (tag == "!!binary") Fail("binary data can't be read here; write numbers");
    SkipSpace();
    return tag == "!!str";
  }

  [[nodiscard]] bool IsListMark() const {
    const char next = Peek(1);
    return EndsWord(next) || next == '{' || next == '[' || next == '"' || next == '\'';
  }

  // Whether a key and its colon stand here; an address ("rtsp://…") is none.
  [[nodiscard]] bool IsKey() const {
    const std::size_t end = KeyEnd(at_);
    return end != std::string_view::npos && end > at_;
  }
  [[nodiscard]] std::size_t KeyEnd(std::size_t at) const {
    const char quote = text_[at];
    if (quote == '"' || quote == '\'') {
      at = text_.find_first_of(quote == '"' ? "\"\n" : "'\n", at + 1);
      if (at == std::string_view::npos || text_[at] == '\n') return std::string_view::npos;
      at = text_.find_first_not_of(' ', at + 1);
      return at != std::string_view::npos && text_[at] == ':' ? at : std::string_view::npos;
    }
    for (; at < text_.size() && !IsBreak(text_[at]); ++at) {
      if (text_[at] == '#' && text_[at - 1] == ' ') break;
      if (text_[at] == ':' && (at + 1 == text_.size() || text_[at + 1] != '/')) return at;
    }
    return std::string_view::npos;
  }

  void BlockList(YamlNode& node, int depth) {
    node.kind = YamlKind::kList;
    const int column = Column();
    while (!AtEnd() && Column() == column && Peek() == '-' && IsListMark()) {
      ++at_;
      SkipSpace();
      node.items.push_back(Value(column + 1, depth + 1));
      SkipSpace();
    }
    RequireEndOfBlock(column);
  }

  void BlockMap(YamlNode& node, int depth) {
    node.kind = YamlKind::kMap;
    const int column = Column();
    std::unordered_set<std::string> seen;
    while (!AtEnd() && Column() == column && !EndsDocument() && IsKey()) {
      AddKey(node, seen, KeyEnd(at_));
      ++at_;  // the colon
      SkipSpace();
      const bool is_list = !AtEnd() && Column() == column && Peek() == '-' && IsListMark();
      node.items.push_back(Value(is_list ? column : column + 1, depth + 1));
      SkipSpace();
    }
    RequireEndOfBlock(column);
  }

  [[nodiscard]] bool EndsDocument() const {
    const std::string_view rest = text_.substr(at_, 3);
    return Column() == 0 && (rest == "..." || rest == "---");
  }
  void RequireEndOfBlock(int column) const {
    if (!AtEnd() && Column() > column)
      Fail("indented more than its neighbours; indent keys of one map alike");
  }

  // Reads a key, up to its colon.
  void AddKey(YamlNode& node, std::unordered_set<std::string>& seen, std::size_t end) {
    std::string key(text_.substr(at_, end - at_));
    key.erase(key.find_last_not_of(' ') + 1);
    if (key.size() >= 2 && (key.front() == '"' || key.front() == '\'') && key.back() == key.front())
      key = key.substr(1, key.size() - 2);
    if (key.empty()) Fail("a key without a name; write it before the colon");
    if (key.size() > kLongestKeyBytes || !core::IsPlain(key)) Fail("no key begins here; correct this line");
    if (!seen.insert(key).second) Fail(fmt::format("key '{}' occurs twice; keep one", key));
    node.keys.push_back(std::move(key));
    at_ = end;
  }

  // Reads "[ 1, 2 ]" or "{ a: 1 }", over any number of lines.
  void Flow(YamlNode& node, int depth) {
    const bool is_map = Peek() == '{';
    const char close = is_map ? '}' : ']';
    node.kind = is_map ? YamlKind::kMap : YamlKind::kList;
    std::unordered_set<std::string> seen;
    ++flow_depth_;
    ++at_;
    for (SkipSpace(); Peek() != close; SkipSpace()) {
      if (AtEnd()) Fail(fmt::format("the '{}' of line {} has no '{}'", is_map ? '{' : '[', node.line, close));
      if (is_map) {
        AddKey(node, seen, FlowKeyEnd());
        ++at_;
        SkipSpace();
      }
      node.items.push_back(FlowValue(depth + 1));
      SkipSpace();
      if (Peek() == ',' && !AtEnd()) {
        ++at_;
      } else if (AtEnd() || Peek() != close) {
        Fail(fmt::format("',' or '{}' must stand here", close));
      }
    }
    --flow_depth_;
    ++at_;
  }

  [[nodiscard]] std::size_t FlowKeyEnd() const {
    const std::size_t end = KeyEnd(at_);
    const std::size_t stop = text_.find_first_of(",{}[]\n", at_);
    if (end == std::string_view::npos || end > stop) Fail("a key and a colon must stand here");
    return end;
  }

  YamlNode FlowValue(int depth) {
    YamlNode node = Begin(depth);
    const bool is_text = SkipTag();
    if (!AtEnd() && (Peek() == '[' || Peek() == '{')) {
      Flow(node, depth);
    } else {
      Scalar(node, true, is_text);
    }
    return node;
  }

  void Scalar(YamlNode& node, bool in_flow, bool is_text) {
    node.kind = YamlKind::kText;
    if (Peek() == '"') return DoubleQuoted(node);
    if (Peek() == '\'') return SingleQuoted(node);
    if (std::string_view("&*|>?@`").find(Peek()) != std::string_view::npos)
      Fail(fmt::format("'{}' can't begin a value here; put texts in quotes", Peek()));
    const std::size_t begin = at_;
    while (!AtEnd() && !IsBreak(Peek()) && !(Peek() == '#' && at_ > begin && text_[at_ - 1] == ' ') &&
           !(in_flow && std::string_view(",[]{}").find(Peek()) != std::string_view::npos))
      ++at_;
    std::string_view plain = text_.substr(begin, at_ - begin);
    plain = plain.substr(0, plain.find_last_not_of(' ') + 1);
    if (plain.empty()) Fail("a value is missing here");
    RequirePlain(plain);
    node.text = plain;
    if (!is_text) PutPlainScalar(plain, &node);
  }

  void RequirePlain(std::string_view text) const {
    if (!core::IsPlain(text)) Fail("characters that are no text; the file is damaged, or not UTF-8");
  }

  // The next byte of a quoted text. If the line ends here, the quote isn't closed.
  char TakeQuoted() {
    if (AtEnd() || IsBreak(Peek())) Fail("a quote isn't closed; close it in the same line");
    return text_[at_++];
  }

  void SingleQuoted(YamlNode& node) {
    ++at_;
    while (true) {
      const char c = TakeQuoted();
      if (c == '\'') {
        if (Peek() != '\'') break;
        ++at_;
      }
      node.text += c;
    }
    RequirePlain(node.text);
  }

  void DoubleQuoted(YamlNode& node) {
    ++at_;
    for (char c = TakeQuoted(); c != '"'; c = TakeQuoted()) node.text += c == '\\' ? Escaped() : c;
    RequirePlain(node.text);
  }

  char Escaped() {
    const char c = TakeQuoted();
    if (c == '"' || c == '\\' || c == '\'' || c == '/' || c == ' ') return c;
    if (c == 'x') {
      unsigned byte = 0;
      const char* begin = text_.data() + at_;
      const char* end = text_.data() + std::min(at_ + 2, text_.size());
      if (std::from_chars(begin, end, byte, 16).ptr == begin + 2) {
        at_ += 2;
        return static_cast<char>(byte);
      }
    }
    Fail(fmt::format("'\\{}' means nothing in a quoted text; write '\\\\' for a backslash", c));
  }

  std::string_view text_;
  const std::string& who_;
  std::size_t at_ = 0;
  std::size_t line_begin_ = 0;
  int line_ = 1;
  std::size_t values_ = 0;
  int flow_depth_ = 0;  // inside of [ ] and { } columns mean nothing, and tabs are space
};

}  // namespace

const YamlNode* YamlNode::Find(std::string_view key) const {
  const auto found = std::ranges::find(keys, key);
  return found == keys.end() ? nullptr : &items[static_cast<std::size_t>(found - keys.begin())];
}

void PutPlainScalar(std::string_view plain, YamlNode* node) {
  node->kind = YamlKind::kText;
  node->text = plain;
  const auto number = NumberOf(plain);
  if (!number) return;
  node->kind = IsInteger(plain, *number) ? YamlKind::kInteger : YamlKind::kReal;
  node->number = *number;
}

YamlNode ParseYaml(std::string_view text, const std::string& who, YamlHeader header) {
  return YamlParser(text, who).Document(header);
}

}  // namespace elbowroom::recon
