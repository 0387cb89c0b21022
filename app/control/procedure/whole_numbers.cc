#include "app/control/procedure/whole_numbers.h"

#include <cstdint>

#include "core/session.h"

namespace elbowroom::control {

std::optional<int> WholeNumber(const toml::node& node, int least, int most) {
  const auto number = node.value_exact<std::int64_t>();
  if (!number || *number < least || *number > most) return std::nullopt;
  return static_cast<int>(*number);
}

std::optional<std::pair<int, int>> ReadScaleEnds(const cad_import::TomlEntry& entry) {
  const toml::node* node = entry.Find("scale");
  if (node == nullptr) return std::nullopt;
  const toml::array* ends = node->as_array();
  constexpr const char* kShape = "must be two whole numbers, the least first: [1, 7]";
  if (ends == nullptr || ends->size() != 2) entry.Fail("scale", kShape);
  const auto least = WholeNumber(*ends->get(0), -core::kWidestScale, core::kWidestScale);
  const auto most = WholeNumber(*ends->get(1), -core::kWidestScale, core::kWidestScale);
  if (!least || !most || *least >= *most) entry.Fail("scale", kShape);
  return std::pair(*least, *most);
}

}  // namespace elbowroom::control
