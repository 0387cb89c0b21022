// A home folder of its own for a program of tests: what it remembers and records isn't the user's.
#pragma once

#include <QByteArray>
#include <QCoreApplication>

#include "tests/support/temporary_folder.h"

namespace elbowroom::console {

// Before QApplication is made.
class OwnHome {
 public:
  OwnHome() {
    for (const char* variable : {"HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_DOCUMENTS_DIR"})
      qputenv(variable, QByteArray::fromStdString(folder_.path().string()));
    QCoreApplication::setOrganizationName("Elbowroom");
    QCoreApplication::setApplicationName("tests");
  }

 private:
  test_support::TemporaryFolder folder_;
};

}  // namespace elbowroom::console
