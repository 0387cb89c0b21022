// The options that name a part and where it stands.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/cli/options/command.h"
#include "core/bvh.h"
#include "core/rigid_transform.h"
#include "core/units.h"

namespace elbowroom::cli {

struct PartOptions {
  std::filesystem::path mesh;
  std::optional<core::LengthUnit> unit;
  std::filesystem::path world_from_part;  // empty: where its file has it
};

struct PosedPart {
  std::shared_ptr<const core::TriangleMesh> mesh;
  core::RigidTransform world_from_part;
};

void AddPartOptions(CLI::App& command, PartOptions* options);

// Throws: core::Error naming the file.
[[nodiscard]] PosedPart LoadPart(const PartOptions& options, const CommandContext& context);

}  // namespace elbowroom::cli
