// Numbered or listed image files as frames.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "recon/rig_files/source_location.h"

namespace elbowroom::recon {

// The files of `location` in frame order: one image, every image of a folder by name, every image whose name
// fits a pattern with * and ?, or a printf pattern with one %d or %0Nd in the file's name whose numbers begin
// at 0 or 1. `who` begins messages, as in "camera 'cam01'". Throws: Error{kFormat} for a pattern of another
// form, Error{kFile} if there are no files, if the numbers begin elsewhere, or if there is a gap in them,
// naming the first file that is missing.
[[nodiscard]] std::vector<std::filesystem::path> FindImageFiles(const std::string& location,
                                                                const std::string& who);

}  // namespace elbowroom::recon
