// Whether all of a window or a dialog can be read: texts that are cut off, what lies outside, what overlaps.
#pragma once

#include <QStringList>
#include <QWidget>

namespace elbowroom::console {

// Until what was shown is laid out: a text that wraps gets its height after its width, from the inside out.
void AwaitLayout();

// A line for each fault; none: all texts of labels, buttons, fields, tabs, titles, headings and cells have
// the room that they ask for, no tool bar or menu bar hides a button, no list scrolls sideways, no widget
// leaves its parent, and none lies over a sibling. What scrolls up and down may go on below. Painted texts
// (the 3-D view, the timeline, camera pictures) aren't looked at. `top` is shown.
[[nodiscard]] QStringList FaultsOfFit(const QWidget& top);

}  // namespace elbowroom::console
