// A trial's files, sound, and one of them damaged at random: the same for the same seed.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <random>
#include <string>

namespace elbowroom::adversary {

enum class ConfigurationKind { kRig, kView, kPose, kLayout, kTrial };

inline constexpr std::array kKinds = {ConfigurationKind::kRig, ConfigurationKind::kView,
                                      ConfigurationKind::kPose, ConfigurationKind::kLayout,
                                      ConfigurationKind::kTrial};

// "rig.yml", "view.yml", "pose.yml", "layout.toml", "trial.toml".
[[nodiscard]] std::string NameOf(ConfigurationKind kind);

// Writes a rig of four cameras with ready masks of one frame, a part, and one sound file of each kind.
void WriteSoundTrial(const std::filesystem::path& folder);

// The text of each kind, as WriteSoundTrial wrote it there.
[[nodiscard]] std::map<ConfigurationKind, std::string> SoundTexts(const std::filesystem::path& folder);

// `text` with its bytes damaged (tests/fuzz/mutation.h), or its lines: dropped, doubled, moved, indented, a
// value replaced by one that is too large, of another kind, nested deep or no text at all.
[[nodiscard]] std::string Damaged(const std::string& text, const std::string& other, std::mt19937_64& random);

[[nodiscard]] std::string Repeated(const std::string& text, std::uint64_t times);

}  // namespace elbowroom::adversary
