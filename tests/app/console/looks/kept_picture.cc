#include "tests/app/console/looks/kept_picture.h"

#include <QStringList>
#include <QTest>

namespace elbowroom::console {

QSize WantedSize() {
  const QStringList words = qEnvironmentVariable("ELBOWROOM_SCREENSHOTS_SIZE", "1280x720").split('x');
  return {words.value(0).toInt(), words.value(1).toInt()};
}

void KeepPicture(const char* name, QWidget& top) {
  const QString folder = qEnvironmentVariable("ELBOWROOM_SCREENSHOTS");
  if (folder.isEmpty()) return;
  QTest::qWait(1500);  // until the picture is drawn in full
  top.grab().save(QString("%1/%2.png").arg(folder, name));
}

}  // namespace elbowroom::console
