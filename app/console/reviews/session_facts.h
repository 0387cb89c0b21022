// What stands above a session under review.
#pragma once

#include <QString>

#include "app/control/reviewing/reviewed_session.h"

namespace elbowroom::console {

[[nodiscard]] QString TitleOf(const control::ReviewedSession& session);  // its task and file
// Who, when, how many frames, cameras and touches, and whether it was cut off or replayed.
[[nodiscard]] QString FactsOf(const control::ReviewedSession& session);

}  // namespace elbowroom::console
