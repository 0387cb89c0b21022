// A camera, by its number or its address, as a source of pictures.
#pragma once

#include <memory>
#include <stop_token>

#include "recon/footage/image_source.h"
#include "recon/footage/source_subject.h"

namespace elbowroom::recon {

// Throws: as OpenImageSource; Error{kFormat} for "device:" without a number, Error{kCamera} for a device that
// can't be opened.
[[nodiscard]] std::unique_ptr<ImageSource> OpenLiveCamera(SourceSubject subject, const std::stop_token& stop);

}  // namespace elbowroom::recon
