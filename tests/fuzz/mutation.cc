#include "tests/fuzz/mutation.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

namespace elbowroom::fuzz {
namespace {

constexpr std::array kExtremeBytes = {'\x00', '\x01', '\x7f', '\x80', '\xff', '"', '<', '\n'};
constexpr std::array kExtremeNumbers = {"0",
                                        "-1",
                                        "4294967295",
                                        "2147483648",
                                        "18446744073709551615",
                                        "1e308",
                                        "-1e308",
                                        "1e-320",
                                        "nan",
                                        "inf",
                                        "99999999999999999999",
                                        "#0",
                                        "1000000000",
                                        "-99999999",
                                        "0x7fffffff",
                                        ""};

class Mutator {
 public:
  Mutator(std::string* bytes, const std::string& other, std::mt19937_64& random)
      : bytes_(*bytes), other_(other), random_(random) {}

  void MutateOnce() {
    if (bytes_.empty()) return;
    switch (Below(8)) {
      case 0:
        bytes_[Below(bytes_.size())] ^= static_cast<char>(1U << Below(8));
        break;
      case 1:
        FillPiece();
        break;
      case 2:
        bytes_.erase(Below(bytes_.size()), Below(64) + 1);
        break;
      case 3:
        bytes_.insert(Below(bytes_.size()), bytes_.substr(Below(bytes_.size()), Below(4096) + 1));
        break;
      case 4:
        bytes_.resize(Below(bytes_.size()));
        break;
      case 5:
        ReplaceNumber();
        break;
      case 6:
        bytes_.insert(Below(bytes_.size()), other_.substr(Below(other_.size() + 1), Below(1024)));
        break;
      default:
        for (std::uint64_t i = Below(32) + 1; i > 0; --i)
          bytes_[Below(bytes_.size())] = static_cast<char>(random_());
    }
  }

 private:
  std::uint64_t Below(std::uint64_t end) { return random_() % end; }
  void FillPiece() {
    const std::uint64_t begin = Below(bytes_.size());
    const std::uint64_t size = std::min(Below(8) + 1, bytes_.size() - begin);
    std::fill_n(bytes_.begin() + static_cast<std::ptrdiff_t>(begin), size,
                kExtremeBytes[Below(kExtremeBytes.size())]);
  }

  void ReplaceNumber() {
    const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    const auto begin = std::find_if(bytes_.begin() + static_cast<std::ptrdiff_t>(Below(bytes_.size())),
                                    bytes_.end(), is_digit);
    const auto end = std::find_if_not(begin, bytes_.end(), is_digit);
    bytes_.replace(begin, end, kExtremeNumbers[Below(kExtremeNumbers.size())]);
  }

  std::string& bytes_;
  const std::string& other_;
  std::mt19937_64& random_;
};

}  // namespace

std::string Mutated(std::string bytes, const std::string& other, std::mt19937_64& random) {
  Mutator mutator(&bytes, other, random);
  for (std::uint64_t i = random() % 6 + 1; i > 0; --i) mutator.MutateOnce();
  return bytes;
}

}  // namespace elbowroom::fuzz
