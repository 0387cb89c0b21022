#include "tests/sessions/sample_session.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <utility>

#include "core/surface_patches.h"
#include "sessions/session_writer.h"

namespace elbowroom::tests {
namespace {

using Random = std::mt19937;

double Between(Random& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}
Eigen::Vector3d VectorFrom(Random& random) {
  const double x = Between(random, -500.0, 500.0), y = Between(random, -500.0, 500.0),
               z = Between(random, 0.0, 900.0);
  return {x, y, z};
}

core::CameraModel Camera(const std::string& name, core::DistortionModel model,
                         std::vector<double> coefficients, const Eigen::Vector3d& eye_in_world) {
  core::CameraCalibration calibration;
  calibration.name = name;
  calibration.image_width_px = 130;  // not a multiple of 64: rows have padding
  calibration.image_height_px = 97;
  calibration.camera_matrix << 151.0 / 3.0, 0.0, 64.5, 0.0, 50.1, 48.0, 0.0, 0.0, 1.0;
  calibration.distortion_model = model;
  calibration.distortion_coefficients = std::move(coefficients);
  calibration.cam_from_world = core::CamFromWorldLookingAt(eye_in_world, {0.0, 0.0, 100.0});
  return core::CameraModel(std::move(calibration));
}

core::SharedMesh Tetrahedron(double edge_mm, double deviation_mm = 0.0) {
  core::TriangleMesh mesh;
  mesh.deviation_mm = deviation_mm;
  mesh.vertices_mm = {{0.0, 0.0, 0.0}, {edge_mm, 0.0, 0.0}, {0.0, edge_mm, 0.0}, {0.0, 0.0, edge_mm / 3.0}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return std::make_shared<const core::TriangleMesh>(std::move(mesh));
}

core::BitMask Blob(int width_px, int height_px, Random& random) {
  core::BitMask mask(width_px, height_px);
  const double x0 = Between(random, 0.0, width_px), y0 = Between(random, 0.0, height_px);
  const double radius_px = Between(random, 5.0, 60.0);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) mask.Set(x, y, std::hypot(x - x0, y - y0) < radius_px);
  }
  return mask;
}

// With levels as a segmented picture has them.
core::SoftMask WithLevels(core::BitMask mask, Random& random) {
  core::SoftMask soft{std::move(mask), {}};
  const core::BitMask boundary = core::BoundaryPixels(soft.mask);
  for (int y = 0; y < soft.mask.height_px(); ++y) {
    for (int x = 0; x < soft.mask.width_px(); ++x) {
      if (!boundary.At(x, y)) continue;
      const unsigned least = soft.mask.At(x, y) ? 128 : 0;
      soft.levels.push_back(static_cast<std::uint8_t>(least + random() % 128));
    }
  }
  return soft;
}

core::PartContact Touch(Random& random) {
  core::PartContact contact;
  contact.verdict = core::Verdict::kContact;
  for (int i = 0; i < 12; ++i)
    contact.points.push_back({VectorFrom(random), Between(random, 0.0, 20.0), 1.0 / 3.0});
  contact.contact_point_count = 412;
  contact.contact_area_mm2 = Between(random, 1.0, 900.0);
  contact.deepest = contact.points[3];
  return contact;
}

void AddRecovery(core::PartContact& contact, bool on_workspace_face, Random& random) {
  contact.recovery_status = core::RecoveryStatus::kFound;
  contact.recovery = core::Recovery{VectorFrom(random), VectorFrom(random), VectorFrom(random).normalized(),
                                    Between(random, 0.0, 50.0), std::nullopt};
  if (!on_workspace_face) contact.recovery->n_hull_in_world = VectorFrom(random).normalized();
}

// Of a contact, of a part that was searched for, and of one that a ball or an empty hull settled.
void AddClearances(core::FrameRecord* record) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  core::PartClearance& met = record->contacts[0].clearance.emplace();
  const Eigen::Vector3d at = record->contacts[0].points[3].position_in_world_mm;
  met = {{0.0, 0.0, at, at}, true, 0};
  core::PartClearance& searched = record->contacts[2].clearance.emplace();
  searched = {{20.0 / 3.0, 22.0 / 3.0, {1.0 / 3.0, 2.0, 3.0}, {4.0, 5e-9, 6.0}}, true, 412 + record->frame};
  searched.budget = core::ErrorBudget{1.0 / 3.0, 0.0, 1.0 / 7.0, 1.0 / 9.0, 1.0 / 11.0};
  if (record->contacts[2].verdict != core::Verdict::kClear) return;
  searched = {{record->frame == 2 ? kInfinity : 21.1, kInfinity, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, false, 1};
}

// In turn: of two cameras, of the first alone, none.
void AddStamps(std::size_t cameras, core::FrameRecord* record) {
  if (record->frame % 3 == 2) return;
  const auto count = static_cast<std::uint64_t>(record->frame);
  record->stamps.resize(cameras);
  // More than a double tells apart.
  record->stamps[0] = core::CameraStamp{(std::uint64_t{1} << 62U) + 1U + count, record->time_s - 1e-3 / 3.0};
  if (record->frame % 3 == 0) record->stamps[1] = core::CameraStamp{count, record->time_s + 0.023};
}

// Every kind of item and every rule of a score; "age" isn't answered by SampleEvents().
std::vector<core::Questionnaire> SampleQuestionnaires() {
  core::QuestionnaireItem turned{"turned", "How many figures were <right>?", core::ItemKind::kNumber, 0.0,
                                 20.5};
  core::QuestionnaireItem words{"words", "Say; DROP TABLE question", core::ItemKind::kText, 0.0, 0.0};
  core::QuestionnaireItem there{"there", "O'Hara \"was there\""};
  there.least_anchor = "not at all; DROP";
  there.most_anchor = "as <if>";
  core::QuestionnaireItem lab{"lab", "The laboratory", core::ItemKind::kScale, -3.0, 3.0};
  lab.reversed = true;
  core::QuestionnaireItem sick{"sick", "Nausea", core::ItemKind::kChoice, -0.5, 3.0};
  sick.choices = {"none", "it's \"slight\"", "severe"};
  sick.values = {-0.5, 1.0 / 3.0, 3.0};
  core::QuestionnaireItem age{"age", "Age", core::ItemKind::kNumber, 0.0, 150.0};
  return {{core::AskedWhen::kBefore, "ability", {turned, words}},
          {core::AskedWhen::kAfter,
           "presence; DROP",
           {there, lab, sick, age},
           {{"high", core::ScoreRule::kCount, {{"there"}, {"lab"}}, 1.0, 2.0, 7.0},
            {"total", core::ScoreRule::kSum, {{"sick", 2.0}, {"there", -1.0}}, 9.54},
            {"mean", core::ScoreRule::kMean, {{"lab", 3.0}, {"there"}}},
            {"open", core::ScoreRule::kSum, {{"there"}, {"age"}}}}}};
}

}  // namespace

core::SessionHeader SampleHeader() {
  core::SessionHeader header;
  header.trial = {
      "P. O'Hara <2>", "plug \"J4\" & screw the pipe; DROP TABLE frame", 140.0, 20.1, {"tongs", "driver"},
      1.0 / 3.0};
  header.trial.condition = "gloves; DROP";
  header.trial.order = 2;
  header.trial.steps = {"reach 'in' <b>", "screw; DROP TABLE step"};
  header.trial.survey = {{core::AskedWhen::kBefore, "How sure?", 1, 7},
                         {core::AskedWhen::kAfter, "How sure?", -3, 3},
                         {core::AskedWhen::kAfter, "O'Hara's <i>effort</i>", 0, 100}};
  header.trial.block = "timed; DROP";
  header.trial.questionnaires = SampleQuestionnaires();
  header.rig.name = "bench";
  header.rig.workspace_mm = {Eigen::Vector3d(-500.0, -400.5, 0.0),
                             Eigen::Vector3d(500.0, 400.0, 1000.0 / 3.0)};
  header.rig.unseen = core::UnseenPolicy::kAbstain;
  header.rig.cameras = {
      Camera("left", core::DistortionModel::kPlumbBob, {-0.1, 0.01, 1e-3, -2e-4, 1.0 / 7.0},
             {-900.0, -800.0, 900.0}),
      Camera("above", core::DistortionModel::kFisheye, {0.01, -0.002, 1e-17, 0.0}, {10.0, 0.1, 1500.0})};
  const core::SharedMesh shared_mesh = Tetrahedron(100.0 / 3.0);
  header.layout.unit = core::LengthUnit::kInch;
  header.layout.parts = {{"PMT box", "pmt.stl", core::LengthUnit::kCentimetre, shared_mesh,
                          core::FromPositionAndRollPitchYaw({0.1, -2e-9, 30.0}, {10.0, 20.0, 30.0})},
                         {"payload A", "a.step", std::nullopt, Tetrahedron(80.0, 1.0 / 7.0), {}},
                         {"payload B", "b.obj", core::LengthUnit::kMetre, shared_mesh,
                          core::FromPositionAndRollPitchYaw({400.0, 0.0, 5e300}, {0.0, 0.0, 90.0})}};
  header.layout.spacings = {{"PMT to A", "payload A", "PMT box", core::Axis::kZ, 100.0, 300.0, 140.0},
                            {"side gap", "payloads; DROP", "PMT box", core::Axis::kX, -10.0, 50.0, 0.1}};
  header.layout.groups = {{"payloads; DROP", {"payload B", "payload A"}}, {"box", {"PMT box"}}};
  header.layout.pair_rules = {{"payload A", "PMT box", 12.5, false},
                              {"payload B", "PMT box", 0.0, true},
                              {"payload A", "payload B", 0.0, false, true}};
  header.layout.parts[1].gives_way = core::ClothRule{
      {core::BoundsSide::kZMax, core::BoundsSide::kXMin}, 1e6 / 3.0, 0.1, 0.4, 1.0 / 7.0, 0.3};
  header.layout.parts[2].gives_way = core::PushRule{.max_speed_mm_per_s = 1e3 / 3.0};
  header.layout.streams = {
      {"faucet; DROP", {0.1, -2e-9, 300.0}, {0.0, 1.0 / 3.0, -1.0}, 200.0 / 3.0, 500.0, 3.0}};
  // Its numbers are the same either way across the diagonal.
  const Eigen::Index parameters = 2 * 11 + 5 + 4;
  header.rig_quality.errors = core::RigErrors{
      Eigen::MatrixXd::NullaryExpr(parameters, parameters,
                                   [](Eigen::Index row, Eigen::Index column) {
                                     return row == column ? 1.0 / static_cast<double>(row + 3)
                                                          : -1e-9 * static_cast<double>(row + column);
                                   }),
      1.0 / 7.0};
  header.rig_quality.gauge =
      core::RigGauge{"2024-02-29T08:00:00Z", 10.0, 10.0 + 1.0 / 3.0, 1.0 / 3.0, 0.5, 27, true};
  header.started_at_utc = "2024-03-01T09:30:00Z";
  header.settings = {{"segmentation.method", "threshold"}, {"k_sigma", "4"}};
  header.versions = {{"elbowroom", "0.1.0"}, {"opengl", "llvmpipe"}};
  header.origin = core::SessionOrigin{"first/O'Hara.db",
                                      std::string(32, 'a'),
                                      std::string(32, 'b'),
                                      "2024-03-02T10:00:00Z",
                                      {"spacing 'PMT to A': 240 mm in all frames"}};
  return header;
}

core::FrameRecord SampleFrame(const core::SessionHeader& header, core::FrameIndex frame, std::uint32_t seed) {
  Random random(seed + static_cast<std::uint32_t>(frame) * 7919U);
  core::FrameRecord record;
  record.frame = frame;
  record.time_s = static_cast<double>(frame) / 30.0;
  std::vector<core::SoftMask> masks;
  for (const core::CameraModel& camera : header.rig.cameras)
    masks.push_back({Blob(camera.width_px(), camera.height_px(), random), {}});
  // From a source of their own: without them all else is as in the stored sessions of schema 1.
  Random of_levels(seed + static_cast<std::uint32_t>(frame));
  masks[0] = WithLevels(std::move(masks[0].mask), of_levels);
  record.masks = std::make_shared<const std::vector<core::SoftMask>>(std::move(masks));
  record.spacing_mm = {frame < 4 ? 140.0 : 240.0, 0.1};
  core::PartContact first = Touch(random);
  AddRecovery(first, frame % 2 == 0, random);
  core::PartContact second = Touch(random);
  second.recovery_status = core::RecoveryStatus::kReferenceInsideHull;
  core::PartContact third;
  third.verdict = frame % 3 == 0   ? core::Verdict::kNear
                  : frame % 3 == 1 ? core::Verdict::kUndecided
                                   : core::Verdict::kClear;
  record.contacts = {first, second, third};
  for (core::PartIndex i = 0; i < record.contacts.size(); ++i) {
    record.contacts[i].part = i;
    record.contacts[i].resolution_mm = 0.7;
    record.contacts[i].count = {720, 91 + frame, 654};
  }
  AddClearances(&record);
  AddStamps(header.rig.cameras.size(), &record);
  if (frame >= 3) {
    record.rest_from_parts.resize(3);
    record.rest_from_parts[2] =
        core::FromPositionAndRollPitchYaw({static_cast<double>(frame) / 3.0, 0.0, -1e-9}, {0.0, 7.0, 0.1});
  }
  return record;
}

core::FrameRecord AsOfSchema(int schema, core::FrameRecord record) {
  if (schema < 2) {
    std::vector<core::SoftMask> masks = *record.masks;
    for (core::SoftMask& soft : masks) soft.levels.clear();
    record.masks = std::make_shared<const std::vector<core::SoftMask>>(std::move(masks));
  }
  if (schema < 3) {
    for (core::PartContact& contact : record.contacts) contact.clearance.reset();
  }
  if (schema < 4) record.rest_from_parts.clear();
  if (schema < 7) {
    for (core::PartContact& contact : record.contacts)
      if (contact.clearance) contact.clearance->budget.reset();
  }
  if (schema < 8) {
    record.stamps.clear();
    for (core::PartContact& contact : record.contacts)
      if (contact.clearance && contact.clearance->budget)
        contact.clearance->budget->skew_mm = contact.clearance->budget->given_mm = 0.0;
  }
  return record;
}

core::SessionHeader AsOfSchema(int schema, core::SessionHeader header) {
  if (schema < 3) header.trial.uncertainty_mm = 0.0;
  if (schema < 4) {
    for (core::Part& part : header.layout.parts) part.gives_way = {};
    header.layout.streams.clear();
    header.layout.pair_rules.pop_back();
  }
  if (schema < 5) {
    header.layout.parts[1].file.clear();
    header.layout.parts[1].unit = core::LengthUnit::kMillimetre;
    header.layout.parts[1].mesh = Tetrahedron(80.0);
  }
  if (schema < 6) {
    header.layout.groups.clear();
    header.layout.spacings[1].moving = "payload B";
  }
  if (schema < 7) header.rig_quality = {};
  if (schema < 9) header.origin.reset();
  if (schema < 10) {
    header.trial.condition.clear();
    header.trial.order = 0;
    header.trial.steps.clear();
    header.trial.survey.clear();
  }
  if (schema < 11) {
    header.trial.block.clear();
    header.trial.questionnaires.clear();
  }
  return header;
}

std::vector<core::SessionEvent> SampleEvents() {
  using core::AskedWhen;
  return {{0, 0.0, core::SurveyAnswered{AskedWhen::kBefore, "How sure?", 6}},
          {0, 0.0, core::EstimateGiven{AskedWhen::kBefore, 140.0}},
          {0, 0.0, core::QuestionnaireAnswered{AskedWhen::kBefore, "ability", "turned", 37.0 / 3.0}},
          {0, 0.0, core::QuestionnaireAnswered{AskedWhen::kBefore, "ability", "words", "<i>it's</i>; DROP"}},
          {1, 1 / 30.0, core::StepMarked{"reach 'in' <b>", true}},
          {2, 2 / 30.0, core::ToolMarked{"tongs", true}},
          {2, 2 / 30.0, core::Bookmark{"<dropped> it"}},
          {4, 4 / 30.0, core::SpacingChanged{"PMT to A", 140.0, 240.0}},
          {4, 4 / 30.0, core::ToolMarked{"tongs", false}},
          {4, 4 / 30.0, core::StepMarked{"reach 'in' <b>", false}},
          {4, 4 / 30.0, core::StepMarked{"screw; DROP TABLE step", true}},
          {5, 5 / 30.0, core::Bookmark{}},
          {6, 6 / 30.0, core::Note{"ended at the shortest source: 'left' <&>"}},
          {6, 6 / 30.0, core::EstimateGiven{AskedWhen::kAfter, 200.0 / 3.0}},
          {6, 6 / 30.0, core::SurveyAnswered{AskedWhen::kAfter, "How sure?", -3}},
          {6, 6 / 30.0, core::SurveyAnswered{AskedWhen::kAfter, "How sure?", 2}},
          {6, 6 / 30.0, core::QuestionnaireAnswered{AskedWhen::kAfter, "presence; DROP", "there", 7.0}},
          {6, 6 / 30.0, core::QuestionnaireAnswered{AskedWhen::kAfter, "presence; DROP", "lab", -2.0}},
          {6, 6 / 30.0,
           core::QuestionnaireAnswered{AskedWhen::kAfter, "presence; DROP", "sick", "it's \"slight\""}},
          {6, 6 / 30.0, core::QuestionnaireAnswered{AskedWhen::kAfter, "presence; DROP", "there", 6.0}}};
}

std::vector<core::ContactEpisode> SampleEpisodes(core::FrameIndex first, core::FrameIndex last) {
  std::vector<core::ContactEpisode> episodes(2);
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    core::ContactEpisode& episode = episodes[i];
    episode.id = static_cast<core::EpisodeId>(i) + 1;
    episode.part = i;
    episode.begin_frame = first;
    episode.peak_frame = (first + last) / 2;
    episode.end_frame = last;
    episode.begin_time_s = static_cast<double>(first) / 30.0;
    episode.peak_time_s = static_cast<double>(episode.peak_frame) / 30.0;
    episode.end_time_s = static_cast<double>(last) / 30.0;
    episode.frames_in_contact = last - first + 1;
    episode.peak_depth_mm = 11.0 / 3.0 + static_cast<double>(i);
    episode.peak_area_mm2 = 321.0;
    episode.peak_position_in_world_mm = {1.0 / 3.0, -20.0, 155.5};
    episode.spacing_at_peak_mm = {140.0, 0.1};
  }
  return episodes;
}

core::SessionOutcome SampleOutcome(core::FrameIndex first, core::FrameIndex last) {
  core::SessionOutcome outcome{SampleEpisodes(first, last), {}, {}};
  outcome.episodes[0].peak_position_in_part_mm = Eigen::Vector3d(1.0 / 7.0, -3.0, 0.0);
  outcome.episodes[0].tools = {"O'Hara's \"driver\"", "tongs"};
  core::NearMiss miss;
  miss.id = 1;
  miss.part = 2;
  miss.begin_frame = miss.closest_frame = first;
  miss.end_frame = last;
  miss.begin_time_s = miss.closest_time_s = static_cast<double>(first) / 30.0;
  miss.end_time_s = static_cast<double>(last) / 30.0;
  miss.frames_below = last - first + 1;
  miss.verdict = core::Verdict::kNear;
  miss.closest = *SampleFrame(SampleHeader(), first, 1).contacts[2].clearance;
  miss.spacing_at_closest_mm = {140.0, 0.1};
  miss.tools = {"tongs"};
  miss.place_in_part_mm = Eigen::Vector3d(-1.0 / 3.0, 7.0, 1e-9);
  outcome.near_misses = {miss};
  const std::size_t patches =
      core::SurfacePatches(SampleHeader().layout.parts[0].mesh, core::kHeatPatchMm).size();
  core::HeatMap map;
  map.dwell_s.assign(patches, 0.0F);
  map.dwell_s[1] = 1.0F / 3.0F;
  map.peak_depth_mm.assign(patches, 0.0F);
  map.peak_depth_mm[1] = 11.1F;
  outcome.heat_maps = {map};
  return outcome;
}

sessions::SessionClosing SampleClosing() {
  sessions::SessionClosing closing;
  core::Finding gone;
  gone.id = std::string(32, 'c');
  gone.part = "payload <A>";
  gone.end_s = 1.0 / 3.0;
  gone.place_in_part_mm = Eigen::Vector3d(0.1, 0.2, 0.3);
  gone.presence = core::FindingPresence::kGone;
  core::Finding unchecked;
  unchecked.id = std::string(32, 'd');
  unchecked.kind = core::FindingKind::kNearMiss;
  unchecked.part = "taken out";
  unchecked.begin_s = 0.1;
  unchecked.end_s = 0.2;
  unchecked.presence = core::FindingPresence::kNotChecked;
  closing.absent = {gone, unchecked};
  closing.remarks = {
      {gone.id, {"2024-03-02T10:00:00Z", "O'Hara", core::ReviewStatus::kReviewed, ""}},
      {gone.id, {"2024-03-02T10:00:01Z", "=cmd|", {}, "<script>alert(1)</script>", std::string(32, '1')}}};
  closing.footage = {{"S.footage/RIG.yml", 1234, {std::byte{1}, std::byte{255}}}};
  return closing;
}

void WriteSampleSession(const std::filesystem::path& path, core::FrameIndex frames) {
  const core::SessionHeader header = SampleHeader();
  sessions::SessionWriter writer(path, header);
  for (core::FrameIndex i = 0; i < frames; ++i) writer.Append(SampleFrame(header, i, 1));
  for (const core::SessionEvent& event : SampleEvents()) writer.Append(event);
  writer.Finish(SampleOutcome(0, frames - 1), SampleClosing());
}

}  // namespace elbowroom::tests
