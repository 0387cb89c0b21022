#include "tests/support/text_file.h"

#include <fstream>
#include <ios>
#include <iterator>

namespace elbowroom::test_support {

void WriteText(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw std::ios_base::failure(file.string() + ": can't be written");
}

std::string ReadText(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::ios_base::failure(file.string() + ": can't be read");
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace elbowroom::test_support
