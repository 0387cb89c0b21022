#include "app/console/view/verdict_word.h"

#include <QObject>

namespace elbowroom::console {

QString VerdictWord(core::Verdict verdict) {
  switch (verdict) {
    case core::Verdict::kContact:
      return QObject::tr("contact");
    case core::Verdict::kNear:
      return QObject::tr("near");
    case core::Verdict::kClear:
      return QObject::tr("clear");
    case core::Verdict::kUndecided:
      return QObject::tr("undecided");
  }
  return {};
}

}  // namespace elbowroom::console
