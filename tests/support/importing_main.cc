// The main of tests that import CAD files: such a program is its own child.
#include <gtest/gtest.h>

#include <cstdlib>

#include "cad_import/import_worker.h"

int main(int argc, char** argv) {
  elbowroom::cad_import::ServeImport(argc, argv);
  ::setenv("ELBOWROOM_CACHE", "off", 0);  // the user's is no business of a test
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
