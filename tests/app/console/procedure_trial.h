// A recorded trial with all that a procedure can have.
#pragma once

#include <filesystem>

namespace elbowroom::console {

// Writes trial.toml with all that it names into the folder: a ball that four cameras see for far longer than
// a test lets pass, two boxes on the spacing "gap" (100 to 220 mm, initially 170), two steps, two tools, one
// question before, two and a questionnaire after.
void WriteProcedureTrial(const std::filesystem::path& folder);

inline constexpr const char* kSecondStep = "screw the pipe in with both hands";

// The words of its files.
inline constexpr const char* kProcedureLayout = R"(unit = "mm"
[[part]]
name = "base"
file = "box.stl"
position_mm = [0, 0, 80]
[[part]]
name = "payload"
file = "box.stl"
position_mm = [0, 0, 250]
[[spacing]]
name = "gap"
moving = "payload"
reference = "base"
axis = "z"
min_mm = 100
max_mm = 220
initial_mm = 170
)";
inline constexpr const char* kProcedureTrial = R"(rig = "rig.yml"
layout = "layout.toml"
task = "Screw the pipe in below the payload"
participant = "P07"
condition = "gloves"
order = 2
block = "timed"
tools = ["tongs", "screwdriver"]
[[step]]
name = "reach in"
[[step]]
name = "screw the pipe in with both hands"
[[survey]]
when = "before"
item = "How sure are you?"
[[survey]]
when = "after"
item = "How sure are you?"
[[survey]]
when = "after"
item = "Effort"
scale = [0, 100]
[[survey]]
when = "after"
file = "feelings.toml"
)";
inline constexpr const char* kProcedureQuestions = R"(name = "Feelings"
[[item]]
id = "there"
text = "Were you there, at the table that you saw?"
anchors = ["not at all", "very much so"]
[[item]]
id = "lab"
text = "Did you notice the laboratory?"
reversed = true
[[item]]
id = "sick"
text = "Nausea"
kind = "choice"
choices = ["none", "slight", "severe"]
[[item]]
id = "age"
text = "Age in years"
kind = "number"
range = [0, 120]
[[item]]
id = "words"
text = "What was in the way?"
kind = "text"
[[score]]
name = "presence"
rule = "mean"
items = ["there", "lab"]
)";

}  // namespace elbowroom::console
