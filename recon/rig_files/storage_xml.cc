#include "recon/rig_files/storage_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <unordered_set>
#include <utility>

#include "core/error.h"
#include "core/plain_text.h"

namespace elbowroom::recon {
namespace {

constexpr std::string_view kXmlRoot = "opencv_storage";
constexpr std::string_view kXmlSpace = " \t\r\n";

// A recursive descent through the text, a byte at a time.
class StorageXmlParser {
 public:
  StorageXmlParser(std::string_view text, const std::string& who) : text_(text), who_(who) {}

  YamlNode Document() {
    if (text_.starts_with("\xEF\xBB\xBF")) Advance(3);
    SkipSpaceAndComments();
    if (!StartsTag()) Fail("it must begin with a tag; check that it is the right file, whole");
    const Tag root = TakeTag();
    if (root.name != kXmlRoot || root.is_end)
      Fail(fmt::format("its first tag must be <{}>; check that it is a file of OpenCV's", kXmlRoot));
    YamlNode node = Content(root, 0);
    if (node.kind != YamlKind::kMap) Fail("it holds no named value");
    return node;
  }

 private:
  struct Tag {
    std::string name;
    bool is_end = false;    // </name>
    bool is_empty = false;  // <name/>
  };

  [[noreturn]] void Fail(const std::string& what) const {
    throw core::Error(core::ErrorKind::kFormat, fmt::format("{}, line {}: {}", who_, line_, what));
  }
  [[nodiscard]] bool AtEnd() const { return at_ >= text_.size(); }
  [[nodiscard]] std::string_view Rest() const { return text_.substr(std::min(at_, text_.size())); }
  [[nodiscard]] bool StartsTag() const { return !AtEnd() && text_[at_] == '<'; }

  void Advance(std::size_t bytes) {
    const std::string_view passed = Rest().substr(0, bytes);
    line_ += static_cast<int>(std::ranges::count(passed, '\n'));
    at_ += passed.size();
  }
  void SkipTo(std::string_view end, const char* what) {
    const std::size_t found = Rest().find(end);
    if (found == std::string_view::npos) Fail(fmt::format("{} has no end", what));
    Advance(found + end.size());
  }
  void SkipSpaceAndComments() {
    while (true) {
      Advance(std::min(Rest().find_first_not_of(kXmlSpace), Rest().size()));
      if (Rest().starts_with("<!--")) {
        SkipTo("-->", "a comment");
      } else if (Rest().starts_with("<?")) {
        SkipTo("?>", "a declaration");
      } else {
        return;
      }
    }
  }

  Tag TakeTag() {
    if (Rest().starts_with("<!")) Fail("a document type or CDATA can't be read here; remove it");
    Tag tag;
    Advance(1);
    if (Rest().starts_with("/")) {
      tag.is_end = true;
      Advance(1);
    }
    const std::size_t name_end = Rest().find_first_of(" \t\r\n/><");
    if (name_end == std::string_view::npos || name_end == 0) Fail("a tag without a name");
    tag.name = Rest().substr(0, name_end);
    if (!core::IsPlain(tag.name)) Fail("characters that are no text; the file is damaged");
    Advance(name_end);
    const std::size_t end = Rest().find_first_of("<>");
    if (end == std::string_view::npos || Rest()[end] == '<')
      Fail(fmt::format("the tag <{}> has no '>'", tag.name));
    tag.is_empty = end > 0 && Rest()[end - 1] == '/';
    Advance(end + 1);
    return tag;
  }

  YamlNode Begin(int depth) {
    constexpr int kDeepestXml = 64;
    constexpr std::size_t kMostXmlValues = 200'000;
    if (depth > kDeepestXml) Fail(fmt::format("nested more than {} deep", kDeepestXml));
    if (++values_ > kMostXmlValues) Fail(fmt::format("more than {} values", kMostXmlValues));
    YamlNode node;
    node.line = line_;
    return node;
  }

  // Everything up to the end tag, which is taken too.
  YamlNode Content(const Tag& begin, int depth) {
    YamlNode node = Begin(depth);
    if (begin.is_empty) return node;
    std::unordered_set<std::string> seen;
    while (true) {
      SkipSpaceAndComments();
      if (AtEnd()) Fail(fmt::format("<{}> has no </{}>", begin.name, begin.name));
      if (!StartsTag()) {
        AddItem({}, Word(depth + 1), &node);
        continue;
      }
      const Tag tag = TakeTag();
      if (!tag.is_end) {
        if (tag.name != "_" && !seen.insert(tag.name).second)
          Fail(fmt::format("<{}> occurs twice; keep one", tag.name));
        AddItem(tag.name, Content(tag, depth + 1), &node);
        continue;
      }
      if (tag.name != begin.name) Fail(fmt::format("</{}> ends what <{}> began", tag.name, begin.name));
      break;
    }
    // A single word is a value, not a list of one.
    if (node.kind == YamlKind::kList && node.items.size() == 1 && is_word_) {
      YamlNode word = std::move(node.items.front());
      node = std::move(word);
    }
    is_word_ = false;
    return node;
  }

  // `name`: of the element; empty: a word.
  void AddItem(const std::string& name, YamlNode item, YamlNode* node) {
    const bool is_map = !name.empty() && name != "_";
    const YamlKind kind = is_map ? YamlKind::kMap : YamlKind::kList;
    if (node->kind != YamlKind::kNothing && node->kind != kind)
      Fail("named and nameless values stand beside each other");
    node->kind = kind;
    is_word_ = name.empty();
    if (is_map) node->keys.push_back(name);
    node->items.push_back(std::move(item));
  }

  // A word between tags, or a text in quotes.
  YamlNode Word(int depth) {
    YamlNode node = Begin(depth);
    const bool is_quoted = Rest().starts_with("\"");
    if (is_quoted) Advance(1);
    const std::size_t end = is_quoted ? Rest().find_first_of("\"<") : Rest().find_first_of(" \t\r\n<");
    const std::string word = Unescaped(Rest().substr(0, end));
    if (is_quoted && (end == std::string_view::npos || Rest()[end] != '"')) Fail("a quote isn't closed");
    Advance(end == std::string_view::npos ? Rest().size() : end + (is_quoted ? 1 : 0));
    if (!core::IsPlain(word)) Fail("characters that are no text; the file is damaged, or not UTF-8");
    node.kind = YamlKind::kText;
    node.text = word;
    if (!is_quoted) PutPlainScalar(word, &node);
    return node;
  }

  std::string Unescaped(std::string_view text) const {
    constexpr std::pair<std::string_view, char> kEntities[] = {
        {"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}};
    std::string plain;
    while (!text.empty()) {
      const auto entity =
          std::ranges::find_if(kEntities, [&](const auto& known) { return text.starts_with(known.first); });
      const bool is_entity = entity != std::end(kEntities);
      plain += is_entity ? entity->second : text.front();
      text.remove_prefix(is_entity ? entity->first.size() : 1);
    }
    return plain;
  }

  std::string_view text_;
  const std::string& who_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::size_t values_ = 0;
  bool is_word_ = false;  // the last item was a word, not an element
};

}  // namespace

YamlNode ParseStorageXml(std::string_view text, const std::string& who) {
  return StorageXmlParser(text, who).Document();
}

}  // namespace elbowroom::recon
