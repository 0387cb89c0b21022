// make_first_rig FOLDER: draws the pictures of docs/examples/first_rig anew.
#include <cstdio>

#include "tests/examples/first_rig.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("make_first_rig FOLDER\n", stderr);
    return 2;
  }
  elbowroom::examples::DrawFirstRig(argv[1]);
  return 0;
}
