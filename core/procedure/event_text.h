// What happened, in words: for lists and timelines.
#pragma once

#include <string>
#include <string_view>

#include "core/session.h"

namespace elbowroom::core {

// The words by which tables and tooltips call it: "spacing", "tool", "note", "step", "bookmark", "estimate",
// "answer", "questionnaire".
[[nodiscard]] std::string_view KindOf(const EventContent& what);

// In English, without time and frame: "PMT to A from 140 to 150 mm", "tongs taken in use", "step 'screw the
// pipe in' begun", "bookmark", "estimate after the trial: 240 mm".
[[nodiscard]] std::string EventText(const EventContent& what);

}  // namespace elbowroom::core
