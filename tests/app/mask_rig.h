// A small rig on disk that sees a ball, in ready masks or in pictures, for tests that run the program.
#pragma once

#include <filesystem>

namespace elbowroom::test_support {

inline constexpr double kBallRadiusMm = 60.0;  // about (0, 0, 200) in world

// Writes rig.yml and cam1..cam4/mask_0000.png below `folder`; four 320 x 240 cameras around the ball.
// Returns the path of rig.yml.
std::filesystem::path WriteBallRig(const std::filesystem::path& folder);

// The same rig with pictures: cam1..cam4/ball_0000.png, and cloth_0000.png... of what stands behind; noise of
// 1.5 grey levels, pixels on edges mixed from 16 rays.
std::filesystem::path WriteBallFootage(const std::filesystem::path& folder);

// An STL box of that size about the origin, in millimetres.
void WriteBoxStl(const std::filesystem::path& file, double size_mm);

// The same with a box-shaped cavity in its middle.
void WriteHollowBoxStl(const std::filesystem::path& file, double size_mm, double cavity_mm);

}  // namespace elbowroom::test_support
