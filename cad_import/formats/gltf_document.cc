#include "cad_import/formats/gltf_document.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

using nlohmann::json;

template <std::size_t kCount>
std::array<double, kCount> NumbersAt(const json& node, const char* key,
                                     const std::array<double, kCount>& fallback) {
  return node.contains(key) ? node.at(key).get<std::array<double, kCount>>() : fallback;
}

// Scaled, then turned, then moved.
json MatrixOf(const json& node) {
  const auto t = NumbersAt<3>(node, "translation", {0.0, 0.0, 0.0});
  const auto q = NumbersAt<4>(node, "rotation", {0.0, 0.0, 0.0, 1.0});  // x, y, z, w
  const auto s = NumbersAt<3>(node, "scale", {1.0, 1.0, 1.0});
  const Eigen::Affine3d matrix = Eigen::Translation3d(t[0], t[1], t[2]) *
                                 Eigen::Quaterniond(q[3], q[0], q[1], q[2]) *
                                 Eigen::Scaling(s[0], s[1], s[2]);
  return std::vector<double>(matrix.matrix().data(), matrix.matrix().data() + 16);  // column by column
}

bool IsVersion1(const json& asset) {
  const json version = asset.value("version", json());
  return version == 1 || (version.is_string() && version.get<std::string>().starts_with('1'));
}

double DeviationMmOf(const json& asset) {
  if (!asset.contains("extras") || !asset["extras"].is_object()) return 0.0;
  const json deviation = asset["extras"].value("deviation_mm", json());
  const double deviation_mm = deviation.is_number() ? deviation.get<double>() : 0.0;
  return std::isfinite(deviation_mm) && deviation_mm > 0.0 ? deviation_mm : 0.0;
}

}  // namespace

GltfAsset AssetOf(std::string_view document) {
  // Everything else is passed over.
  const auto keep = [](int depth, json::parse_event_t event, const json& value) {
    return event != json::parse_event_t::key || depth != 1 || value == "asset";
  };
  const json whole = json::parse(document, keep, /*allow_exceptions=*/false);
  if (!whole.is_object() || !whole.contains("asset") || !whole["asset"].is_object()) return {};
  return {IsVersion1(whole["asset"]), DeviationMmOf(whole["asset"])};
}

std::string WithMatrices(std::string_view document, const std::string& where) try {
  json whole = json::parse(document);
  for (json& node : whole["nodes"]) {
    if (node.contains("matrix")) continue;
    node["matrix"] = MatrixOf(node);
    for (const char* key : {"translation", "rotation", "scale"}) node.erase(key);
  }
  return whole.dump();
} catch (const json::exception&) {
  throw core::Error(core::ErrorKind::kFormat,
                    where + ": a glTF node's translation, rotation or scale isn't numbers; export it again");
}

std::string WithDeviation(std::string_view document, double deviation_mm) {
  json whole = json::parse(document);
  whole["asset"]["extras"]["deviation_mm"] = deviation_mm;
  return whole.dump();
}

}  // namespace elbowroom::cad_import
