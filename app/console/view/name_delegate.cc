#include "app/console/view/name_delegate.h"

#include <QStringView>

namespace elbowroom::console {

QString WithLineEnds(const QString& name) {
  static constexpr QStringView kSeparators = u"_-/.";
  static constexpr qsizetype kLongRun = 12;
  static constexpr QChar kLineMayEnd(0x200B);
  QString wrapped;
  for (qsizetype start = 0; start < name.size();) {
    qsizetype end = start;
    while (end < name.size() && !kSeparators.contains(name[end])) ++end;
    const bool is_long = end - start > kLongRun;
    for (; start < end; ++start) {
      wrapped += name[start];
      // Both halves of a sign beyond U+FFFF stay together.
      if (is_long && !name[start].isHighSurrogate() && start + 1 < end) wrapped += kLineMayEnd;
    }
    if (end == name.size()) break;
    wrapped += name[end];
    wrapped += kLineMayEnd;
    start = end + 1;
  }
  return wrapped;
}

QString NameDelegate::displayText(const QVariant& value, const QLocale& locale) const {
  return WithLineEnds(QStyledItemDelegate::displayText(value, locale));
}

}  // namespace elbowroom::console
