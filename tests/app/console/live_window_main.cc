// Tests of windows with live cameras: as offscreen_main.cc, in a network of its own, which a process can only
// enter while it has one thread.
#include <gtest/gtest.h>

#include <QApplication>

#include "cad_import/import_worker.h"
#include "tests/app/console/own_home.h"
#include "tests/app/live_demo.h"
#include "tests/recon/capture/own_network.h"

int main(int argc, char** argv) {
  elbowroom::cad_import::ServeImport(argc, argv);
  qputenv("QT_QPA_PLATFORM", "offscreen");
  testing::InitGoogleTest(&argc, argv);
  if (!GTEST_FLAG_GET(list_tests)) elbowroom::recon::testing::EnterOwnNetwork(elbowroom::control::kCameras);
  const elbowroom::console::OwnHome home;
  const QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
