// What lupdate finds: it reads the sources, and runs nothing.
#include <gtest/gtest.h>

#include <QDirIterator>
#include <QFile>
#include <QRegularExpression>
#include <QString>

#include "tests/support/places.h"

namespace elbowroom::console {
namespace {

constexpr const char* kContext = "elbowroom::console::";

QString TextIn(const QString& path) {
  QFile file(path);
  EXPECT_TRUE(file.open(QIODevice::ReadOnly)) << path.toStdString();
  return QString::fromUtf8(file.readAll());
}

// The file's line of that place in its text.
std::string LineOf(const QString& path, const QString& text, qsizetype place) {
  return path.toStdString() + ":" + std::to_string(text.left(place).count('\n') + 1);
}

TEST(Translation, EveryTextIsFoundByLupdate) {
  static const QRegularExpression not_literal(R"re(\btr\(\s*(?!")[\w.]+)re");
  static const QRegularExpression noop(R"re(QT_TRANSLATE_NOOP\(\s*"([^"]*)")re");
  static const QRegularExpression by_hand(R"re(::translate\()re");
  int files = 0;
  QDirIterator sources(QString::fromStdString((test_support::SourceFolder() / "app/console").string()),
                       {"*.cc", "*.h"}, QDir::Files, QDirIterator::Subdirectories);
  while (sources.hasNext()) {
    const QString path = sources.next();
    const QString text = TextIn(path);
    ++files;
    const bool has_noop = noop.match(text).hasMatch();
    for (auto at = not_literal.globalMatch(text); at.hasNext();) {
      const QRegularExpressionMatch call = at.next();
      EXPECT_TRUE(has_noop) << LineOf(path, text, call.capturedStart())
                            << ": write the text into the call, or mark it by QT_TRANSLATE_NOOP";
    }
    for (auto at = noop.globalMatch(text); at.hasNext();) {
      const QRegularExpressionMatch marked = at.next();
      const QString context = marked.captured(1);
      EXPECT_TRUE(context.startsWith(kContext) && text.contains(context.mid(QString(kContext).size()) + "::"))
          << LineOf(path, text, marked.capturedStart()) << ": the context is the class that says it";
    }
    if (const auto call = by_hand.match(text); call.hasMatch())
      ADD_FAILURE() << LineOf(path, text, call.capturedStart()) << ": lupdate wants tr()";
  }
  EXPECT_GT(files, 100);
}

}  // namespace
}  // namespace elbowroom::console
