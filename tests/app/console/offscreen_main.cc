// Tests of windows: one QApplication on Qt's offscreen platform, whatever display there is; such a program is
// its own child that imports.
#include <gtest/gtest.h>

#include <QApplication>

#include "cad_import/import_worker.h"
#include "tests/app/console/own_home.h"

int main(int argc, char** argv) {
  elbowroom::cad_import::ServeImport(argc, argv);
  qputenv("QT_QPA_PLATFORM", "offscreen");
  testing::InitGoogleTest(&argc, argv);
  const elbowroom::console::OwnHome home;
  const QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
