// A recorded video as a source of pictures.
#pragma once

#include <memory>
#include <stop_token>

#include "recon/footage/image_source.h"
#include "recon/footage/source_subject.h"

namespace elbowroom::recon {

// Throws: as OpenImageSource.
[[nodiscard]] std::unique_ptr<ImageSource> OpenVideoFile(SourceSubject subject, const std::stop_token& stop);

}  // namespace elbowroom::recon
