// The moments of the worst touches, for a report.
#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

#include "app/control/frame_result.h"
#include "app/control/scene_composer.h"
#include "recon/gl/scene/scene_renderer.h"
#include "sessions/report/report.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

// A report shows no more of them in space and as snapshots.
inline constexpr std::size_t kMostMoments = 12;

// Places in TouchesOf(session).touches of the touches, deepest first, then of the near misses, closest first:
// at most kMostMoments.
[[nodiscard]] std::vector<std::size_t> WorstTouches(const sessions::TouchList& list);

// Adds to `pictures` a snapshot of each of these touches, and what the 3-D view shows: these moments, or,
// where nothing was touched, `shown`. Throws: core::Error as SessionReader does, Error{kGraphics},
// Error{kCancelled}.
void AddTouchMoments(const sessions::SessionReader& session, const FrameResult& shown,
                     recon::gl::SceneRenderer& renderer, SceneComposer& composer, std::stop_token stop,
                     sessions::ReportPictures* pictures);

}  // namespace elbowroom::control
