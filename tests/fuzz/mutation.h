// Files damaged at random, the same for the same seed.
#pragma once

#include <random>
#include <string>

namespace elbowroom::fuzz {

// One to six of: bits flipped, bytes replaced by extreme ones, a piece cut out, doubled or moved, the end cut
// off, a decimal number in the text replaced by an extreme one, a piece of `other` put in.
[[nodiscard]] std::string Mutated(std::string bytes, const std::string& other, std::mt19937_64& random);

}  // namespace elbowroom::fuzz
