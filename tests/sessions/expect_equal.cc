#include <gtest/gtest.h>

#include "tests/sessions/sample_session.h"

namespace elbowroom::tests {
namespace {

void ExpectSame(const core::ContactPoint& actual, const core::ContactPoint& expected) {
  EXPECT_EQ(actual.position_in_world_mm, expected.position_in_world_mm);
  EXPECT_EQ(actual.depth_mm, expected.depth_mm);
  EXPECT_EQ(actual.area_mm2, expected.area_mm2);
}

void ExpectSame(const core::Recovery& actual, const core::Recovery& expected) {
  EXPECT_EQ(actual.cp_obj_in_world_mm, expected.cp_obj_in_world_mm);
  EXPECT_EQ(actual.cp_hull_in_world_mm, expected.cp_hull_in_world_mm);
  EXPECT_EQ(actual.v_rec_in_world, expected.v_rec_in_world);
  EXPECT_EQ(actual.d_rec_mm, expected.d_rec_mm);
  EXPECT_EQ(actual.n_hull_in_world, expected.n_hull_in_world);
  EXPECT_EQ(actual.angle_rad, expected.angle_rad);
}

void ExpectSame(const core::PartClearance& actual, const core::PartClearance& expected) {
  EXPECT_EQ(actual.interval.lower_mm, expected.interval.lower_mm);
  EXPECT_EQ(actual.interval.upper_mm, expected.interval.upper_mm);
  EXPECT_EQ(actual.interval.witness_part_in_world_mm, expected.interval.witness_part_in_world_mm);
  EXPECT_EQ(actual.interval.witness_hull_in_world_mm, expected.interval.witness_hull_in_world_mm);
  EXPECT_EQ(actual.has_witnesses, expected.has_witnesses);
  EXPECT_EQ(actual.queries, expected.queries);
  EXPECT_EQ(actual.budget, expected.budget);
}

void ExpectSame(const core::Rig& actual, const core::Rig& expected) {
  EXPECT_EQ(actual.name, expected.name);
  EXPECT_EQ(actual.workspace_mm.min(), expected.workspace_mm.min());
  EXPECT_EQ(actual.workspace_mm.max(), expected.workspace_mm.max());
  EXPECT_EQ(actual.unseen, expected.unseen);
  ASSERT_EQ(actual.cameras.size(), expected.cameras.size());
  for (core::CameraIndex i = 0; i < expected.cameras.size(); ++i) {
    const core::CameraCalibration& a = actual.cameras[i].calibration();
    const core::CameraCalibration& e = expected.cameras[i].calibration();
    EXPECT_EQ(a.name, e.name);
    EXPECT_EQ(a.image_width_px, e.image_width_px);
    EXPECT_EQ(a.image_height_px, e.image_height_px);
    EXPECT_EQ(a.camera_matrix, e.camera_matrix);
    EXPECT_EQ(a.distortion_model, e.distortion_model);
    EXPECT_EQ(a.distortion_coefficients, e.distortion_coefficients);
    EXPECT_EQ(a.cam_from_world, e.cam_from_world);
  }
}

void ExpectSame(const core::Layout& actual, const core::Layout& expected) {
  EXPECT_EQ(actual.unit, expected.unit);
  ASSERT_EQ(actual.parts.size(), expected.parts.size());
  for (core::PartIndex i = 0; i < expected.parts.size(); ++i) {
    EXPECT_EQ(actual.parts[i].name, expected.parts[i].name);
    EXPECT_EQ(actual.parts[i].file, expected.parts[i].file);
    EXPECT_EQ(actual.parts[i].unit, expected.parts[i].unit);
    EXPECT_EQ(*actual.parts[i].mesh, *expected.parts[i].mesh);
    EXPECT_EQ(actual.parts[i].world_from_part, expected.parts[i].world_from_part);
    EXPECT_EQ(actual.parts[i].recovery, expected.parts[i].recovery);
    EXPECT_EQ(actual.parts[i].gives_way, expected.parts[i].gives_way);
  }
  ASSERT_EQ(actual.spacings.size(), expected.spacings.size());
  for (core::SpacingIndex i = 0; i < expected.spacings.size(); ++i) {
    const core::Spacing &a = actual.spacings[i], &e = expected.spacings[i];
    EXPECT_EQ(std::tie(a.name, a.moving, a.reference, a.axis, a.min_mm, a.max_mm, a.initial_mm),
              std::tie(e.name, e.moving, e.reference, e.axis, e.min_mm, e.max_mm, e.initial_mm));
  }
  ASSERT_EQ(actual.pair_rules.size(), expected.pair_rules.size());
  for (std::size_t i = 0; i < expected.pair_rules.size(); ++i) {
    const core::PairRule &a = actual.pair_rules[i], &e = expected.pair_rules[i];
    EXPECT_EQ(std::tie(a.a, a.b, a.required_clearance_mm, a.authorised_contact, a.ignore),
              std::tie(e.a, e.b, e.required_clearance_mm, e.authorised_contact, e.ignore));
  }
  EXPECT_EQ(actual.streams, expected.streams);
  EXPECT_EQ(actual.groups, expected.groups);
}

void ExpectSame(const core::SessionOrigin& actual, const core::SessionOrigin& expected) {
  EXPECT_EQ(std::tie(actual.file, actual.recording_id, actual.first_recording_id, actual.replayed_at_utc,
                     actual.changes),
            std::tie(expected.file, expected.recording_id, expected.first_recording_id,
                     expected.replayed_at_utc, expected.changes));
}

void ExpectSame(const core::RigErrors& actual, const core::RigErrors& expected) {
  EXPECT_EQ(actual.covariance, expected.covariance);
  EXPECT_EQ(actual.boundary_sigma_px, expected.boundary_sigma_px);
}

template <typename Value>
void ExpectSameWherePresent(const std::optional<Value>& actual, const std::optional<Value>& expected) {
  ASSERT_EQ(actual.has_value(), expected.has_value());
  if (expected) ExpectSame(*actual, *expected);
}

}  // namespace

void ExpectEqual(const core::PartContact& actual, const core::PartContact& expected) {
  EXPECT_EQ(actual.part, expected.part);
  EXPECT_EQ(actual.verdict, expected.verdict);
  EXPECT_EQ(actual.contact_point_count, expected.contact_point_count);
  EXPECT_EQ(actual.contact_area_mm2, expected.contact_area_mm2);
  EXPECT_EQ(actual.recovery_status, expected.recovery_status);
  EXPECT_EQ(actual.resolution_mm, expected.resolution_mm);
  EXPECT_EQ(actual.count.triangles, expected.count.triangles);
  EXPECT_EQ(actual.count.queries, expected.count.queries);
  EXPECT_EQ(actual.count.skipped, expected.count.skipped);
  ExpectSameWherePresent(actual.deepest, expected.deepest);
  ExpectSameWherePresent(actual.recovery, expected.recovery);
  ExpectSameWherePresent(actual.clearance, expected.clearance);
  ASSERT_EQ(actual.points.size(), expected.points.size());
  for (std::size_t i = 0; i < expected.points.size(); ++i) ExpectSame(actual.points[i], expected.points[i]);
}

void ExpectEqual(const core::FrameRecord& actual, const core::FrameRecord& expected) {
  EXPECT_EQ(actual.frame, expected.frame);
  EXPECT_EQ(actual.time_s, expected.time_s);
  EXPECT_EQ(*actual.masks, *expected.masks) << "silhouettes of frame " << expected.frame;
  EXPECT_EQ(actual.spacing_mm, expected.spacing_mm);
  ASSERT_EQ(actual.contacts.size(), expected.contacts.size());
  for (std::size_t i = 0; i < expected.contacts.size(); ++i)
    ExpectEqual(actual.contacts[i], expected.contacts[i]);
  EXPECT_EQ(actual.rest_from_parts, expected.rest_from_parts);
  EXPECT_EQ(actual.stamps, expected.stamps);
}

void ExpectEqual(const core::ContactEpisode& actual, const core::ContactEpisode& expected) {
  const auto fields = [](const core::ContactEpisode& e) {
    return std::tie(e.id, e.part, e.begin_frame, e.peak_frame, e.end_frame, e.begin_time_s, e.peak_time_s,
                    e.end_time_s, e.frames_in_contact, e.peak_depth_mm, e.peak_area_mm2,
                    e.spacing_at_peak_mm);
  };
  EXPECT_EQ(fields(actual), fields(expected));
  EXPECT_EQ(actual.peak_position_in_world_mm, expected.peak_position_in_world_mm);
  EXPECT_EQ(actual.peak_position_in_part_mm, expected.peak_position_in_part_mm);
  EXPECT_EQ(actual.tools, expected.tools);
}

void ExpectEqual(const core::NearMiss& actual, const core::NearMiss& expected) {
  const auto fields = [](const core::NearMiss& m) {
    return std::tie(m.id, m.part, m.begin_frame, m.closest_frame, m.end_frame, m.begin_time_s,
                    m.closest_time_s, m.end_time_s, m.frames_below, m.verdict, m.spacing_at_closest_mm,
                    m.tools);
  };
  EXPECT_EQ(fields(actual), fields(expected));
  ExpectSame(actual.closest, expected.closest);
  EXPECT_EQ(actual.place_in_part_mm, expected.place_in_part_mm);
}

void ExpectEqual(const core::SessionHeader& actual, const core::SessionHeader& expected) {
  ExpectSameWherePresent(actual.rig_quality.errors, expected.rig_quality.errors);
  EXPECT_EQ(actual.rig_quality.gauge, expected.rig_quality.gauge);
  EXPECT_EQ(actual.trial.participant, expected.trial.participant);
  EXPECT_EQ(actual.trial.task, expected.trial.task);
  EXPECT_EQ(actual.trial.estimate_mm, expected.trial.estimate_mm);
  EXPECT_EQ(actual.trial.required_clearance_mm, expected.trial.required_clearance_mm);
  EXPECT_EQ(actual.trial.tools, expected.trial.tools);
  EXPECT_EQ(actual.trial.uncertainty_mm, expected.trial.uncertainty_mm);
  EXPECT_EQ(actual.trial.condition, expected.trial.condition);
  EXPECT_EQ(actual.trial.order, expected.trial.order);
  EXPECT_EQ(actual.trial.steps, expected.trial.steps);
  EXPECT_EQ(actual.trial.survey, expected.trial.survey);
  EXPECT_EQ(actual.trial.questionnaires, expected.trial.questionnaires);
  EXPECT_EQ(actual.trial.block, expected.trial.block);
  EXPECT_EQ(actual.started_at_utc, expected.started_at_utc);
  EXPECT_EQ(actual.settings, expected.settings);
  EXPECT_EQ(actual.versions, expected.versions);
  ExpectSameWherePresent(actual.origin, expected.origin);
  ExpectSame(actual.rig, expected.rig);
  ExpectSame(actual.layout, expected.layout);
}

}  // namespace elbowroom::tests
