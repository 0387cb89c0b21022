#include "tests/support/places.h"

namespace elbowroom::test_support {

std::filesystem::path ProgramFile() { return ELBOWROOM_PROGRAM; }
std::filesystem::path SourceFolder() { return ELBOWROOM_SOURCE_DIR; }
std::filesystem::path SharedDataFolder() { return ELBOWROOM_SHARED_DATA_DIR; }

}  // namespace elbowroom::test_support
