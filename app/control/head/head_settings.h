// How the participant's head is tracked: what HEAD.toml says.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "app/control/head/tracker_packet.h"
#include "recon/head_pose/cap.h"
#include "recon/head_pose/head_camera.h"
#include "recon/head_pose/head_pose.h"
#include "recon/headset/headset_protocol.h"

namespace elbowroom::control {

[[nodiscard]] std::optional<recon::HeadSource> ParseHeadSource(std::string_view text);

struct HeadSettings {
  recon::HeadSource source = recon::HeadSource::kFixed;
  // OpenTrack and FreeD.
  std::string address = "0.0.0.0";  // of this computer
  std::optional<int> port;          // nothing: the protocol's own
  std::optional<int> camera;        // FreeD: its number; nothing: any
  ReadingSigns signs = kNoSignChanged;
  core::RigidTransform world_from_tracker;
  core::RigidTransform sensor_from_head;  // the tracked point's frame has the head's axes
  // OpenXR.
  recon::HeadsetSpace space = recon::HeadsetSpace::kStage;
  std::chrono::milliseconds headset_patience{3000};     // before a runtime that doesn't answer is told of
  std::chrono::milliseconds headset_tried_again{3000};  // after it was lost, or couldn't be used
  // Markers on a cap.
  recon::Cap cap = recon::EightSidedCap();
  // A camera on the head, as it was registered by hand.
  std::optional<recon::HeadCamera> head_camera;
  // No tracker: where the eyes are.
  core::RigidTransform world_from_fixed_head = LookingAt({780.0, -60.0, 600.0}, {0.0, 0.0, 170.0});

  [[nodiscard]] int port_or_default() const;
  // The world's pose of a reading.
  [[nodiscard]] core::RigidTransform WorldFromHead(const TrackerReading& reading) const;

  // A head at `eyes` that looks at `target`, upright.
  [[nodiscard]] static core::RigidTransform LookingAt(const Eigen::Vector3d& eyes_in_world,
                                                      const Eigen::Vector3d& target_in_world);
};

// Reads HEAD.toml (docs/head_pose.md), and the cap file that it names, beside it. Throws: Error{kFile,
// kFormat, kRange} with file, line and key.
[[nodiscard]] HeadSettings ReadHeadFile(const std::filesystem::path& path);

// Puts the head camera into a HEAD.toml, which is made where there is none. All else in it stays, comments
// too. Throws: Error{kFile, kFormat}.
void WriteHeadCamera(const std::filesystem::path& path, const recon::HeadCamera& camera);

// Reads CAP.toml. Throws: likewise.
[[nodiscard]] recon::Cap ReadCapFile(const std::filesystem::path& path);
// A cap as ReadCapFile reads it.
[[nodiscard]] std::string CapFileText(const recon::Cap& cap);

}  // namespace elbowroom::control
