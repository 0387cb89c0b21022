// Hulls of a session, kept as files: what its silhouettes' contours are, with the grids to look them up.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "recon/contours/silhouette.h"

namespace elbowroom::control {

// A contour with its grid as it is kept: packed by zstd, with a checksum by which damage is noticed.
[[nodiscard]] std::string Packed(const recon::ContourMap& contour);
// Null: damaged.
[[nodiscard]] std::shared_ptr<const recon::ContourMap> Unpacked(const std::string& packed);

// A hull is kept silhouette by silhouette, each under a hash of its camera and its pixels. Files appear whole
// or not at all; several programs may write into one folder. Thread: one.
class KeptHulls {
 public:
  // Looks through the files there, if there is such a folder; what is damaged counts as not there. `folder`:
  // of one session and one program.
  explicit KeptHulls(std::filesystem::path folder);

  // Gives a hull's new silhouettes their contours. Those that aren't kept are made at once, and waiting to be
  // written. True: none was made.
  bool Complete(std::span<const std::shared_ptr<const recon::Silhouette>> silhouettes);
  // What is waiting, as one file. Throws: core::Error{kFile}.
  void Write();

 private:
  using Key = std::array<std::uint64_t, 2>;
  struct Place {
    std::filesystem::path file;
    std::int64_t offset = 0, bytes = 0;
  };
  void AddFile(const std::filesystem::path& file);
  [[nodiscard]] std::string ReadPacked(const Key& key) const;  // empty: not kept

  std::filesystem::path folder_;
  std::map<Key, Place> places_;
  std::map<Key, std::string> waiting_;
};

}  // namespace elbowroom::control
