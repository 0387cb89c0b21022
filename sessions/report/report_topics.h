// The touches and near misses of a report as topics of a BCF file, for CAD teams.
#pragma once

#include <vector>

#include "sessions/bcf/bcf_topic.h"
#include "sessions/report/report.h"
#include "sessions/report/report_touch.h"
#include "sessions/session_reader.h"

namespace elbowroom::sessions {

// One topic for each touch and near miss of the list, in its order, then one for each finding of the origin
// that isn't here any more. A topic's id is its finding's. Where `pictures` has no camera for a touch, its
// camera looks at the place from some way off.
[[nodiscard]] std::vector<BcfTopic> TopicsOf(const SessionReader& session, const TouchList& list,
                                             const ReportPictures& pictures);

}  // namespace elbowroom::sessions
