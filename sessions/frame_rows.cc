#include "sessions/frame_rows.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "core/error.h"
#include "sessions/database/damage.h"
#include "sessions/recorded_contacts.h"
#include "sessions/row_rules.h"
#include "sessions/stamp_rows.h"

namespace elbowroom::sessions {
namespace {

using core::Error;
using core::ErrorKind;

// Runs the statement to its end: a statement left open would hold its snapshot, and the log could never be
// folded back.
std::int64_t LastRowsId(Statement& statement) {
  const std::int64_t id = statement.Integer(0);
  statement.Run();
  return id;
}

std::vector<double> ReadSpacings(Database& database, core::FrameIndex frame, const std::string& where) {
  Statement rows(
      database,
      "SELECT spacing_index, spacing_mm FROM frame_spacing WHERE frame_index = ? ORDER BY spacing_index");
  std::vector<double> spacing_mm;
  for (rows.With(frame); rows.Next();) {
    RequireInTurn(rows.Integer(0), spacing_mm.size(), where, "spacing");
    spacing_mm.push_back(GapMm(rows.Real(1), where, "a spacing"));
  }
  return spacing_mm;
}

core::SharedMasks ReadSilhouettes(Database& database, const core::Rig& rig, core::FrameIndex frame,
                                  const std::string& where) {
  Statement rows(
      database,
      "SELECT camera_index, width_px, height_px, content_hash, words_zstd, levels_zstd FROM silhouette "
      "JOIN mask USING (mask_id) WHERE frame_index = ? ORDER BY camera_index");
  auto masks = std::make_shared<std::vector<core::SoftMask>>();
  for (rows.With(frame); rows.Next();) {
    const std::string silhouette = fmt::format("{}, silhouette of camera {}", where, rows.Integer(0));
    const core::CameraIndex camera = masks->size();
    RequireInTurn(rows.Integer(0), camera, where, "the silhouette of camera");
    if (camera >= rig.cameras.size() || rows.Integer(1) != rig.cameras[camera].width_px() ||
        rows.Integer(2) != rig.cameras[camera].height_px()) {
      FailAsDamaged(silhouette, "it doesn't belong to the rig");
    }
    const auto levels_zstd =
        rows.IsNull(5) ? std::nullopt : std::optional<std::span<const std::byte>>(rows.Bytes(5));
    masks->push_back(UnpackMask(rows.Bytes(4), levels_zstd, rig.cameras[camera].width_px(),
                                rig.cameras[camera].height_px(), rows.Bytes(3), silhouette));
  }
  return masks;
}

std::vector<core::RigidTransform> ReadMotions(Database& database, std::size_t parts, core::FrameIndex frame,
                                              const std::string& where) {
  Statement rows(database,
                 "SELECT part_index, rotation_rest_from_part, translation_mm FROM part_motion "
                 "WHERE frame_index = ?");
  std::vector<core::RigidTransform> rest_from_parts;
  for (rows.With(frame); rows.Next();) {
    const core::PartIndex part = IndexBelow(rows.Integer(0), parts, where, "part");
    const std::string motion = fmt::format("{}, motion of part {}", where, part);
    rest_from_parts.resize(parts);
    rest_from_parts[part] = {Rotation(MatrixFromJson(rows.Text(1), motion), motion, "its rotation"),
                             Position(VectorFromJson(rows.Text(2), motion), motion, "its way")};
  }
  return rest_from_parts;
}

}  // namespace

bool HasContactRow(const core::PartContact& contact) {
  return contact.verdict == core::Verdict::kContact || contact.contact_point_count != 0 ||
         !contact.points.empty() || contact.contact_area_mm2 != 0.0 || contact.deepest || contact.recovery ||
         contact.recovery_status != core::RecoveryStatus::kNoContact;
}

FrameInserter::FrameInserter(Database& database)
    : insert_frame_(database, "INSERT INTO frame VALUES (?, ?)"),
      insert_spacing_(database, "INSERT INTO frame_spacing VALUES (?, ?, ?)"),
      find_mask_(database, "SELECT mask_id FROM mask WHERE content_hash = ?"),
      insert_mask_(database,
                   "INSERT INTO mask (content_hash, width_px, height_px, object_px, words_zstd, levels_zstd) "
                   "VALUES (?, ?, ?, ?, ?, ?) RETURNING mask_id"),
      insert_silhouette_(database, "INSERT INTO silhouette VALUES (?, ?, ?)"),
      insert_part_frame_(database, "INSERT INTO part_frame VALUES (?, ?, ?, ?, ?, ?, ?)"),
      insert_contact_(
          database,
          "INSERT INTO contact VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
          "?)"),
      insert_point_(database, "INSERT INTO contact_point VALUES (?, ?, ?, ?, ?, ?, ?, ?)"),
      insert_clearance_(database,
                        "INSERT INTO clearance VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
      insert_motion_(database, "INSERT INTO part_motion VALUES (?, ?, ?, ?)"),
      insert_stamp_(database, "INSERT INTO camera_stamp VALUES (?, ?, ?, ?)") {}

void FrameInserter::Insert(const core::FrameRecord& record) {
  insert_frame_.With(record.frame, record.time_s).Run();
  for (core::SpacingIndex i = 0; i < record.spacing_mm.size(); ++i) {
    insert_spacing_.With(record.frame, i, record.spacing_mm[i]).Run();
  }
  InsertSilhouettes(record.frame, *record.masks);
  for (const core::PartContact& contact : record.contacts) InsertPart(record.frame, contact);
  InsertMotions(record);
  InsertStamps(record);
}

void FrameInserter::InsertStamps(const core::FrameRecord& record) {
  for (core::CameraIndex i = 0; i < record.stamps.size(); ++i) {
    const std::optional<core::CameraStamp>& stamp = record.stamps[i];
    insert_stamp_
        .With(record.frame, i, stamp ? std::optional(stamp->picture) : std::nullopt,
              stamp ? std::optional(stamp->time_s) : std::nullopt)
        .Run();
  }
}

void FrameInserter::InsertMotions(const core::FrameRecord& record) {
  for (core::PartIndex i = 0; i < record.rest_from_parts.size(); ++i) {
    const core::RigidTransform& rest_from_part = record.rest_from_parts[i];
    if (rest_from_part == core::RigidTransform()) continue;
    insert_motion_
        .With(record.frame, i, JsonFrom(rest_from_part.rotation), JsonFrom(rest_from_part.translation_mm))
        .Run();
  }
}

void FrameInserter::InsertSilhouettes(core::FrameIndex frame, std::span<const core::SoftMask> masks) {
  for (core::CameraIndex camera = 0; camera < masks.size(); ++camera) {
    insert_silhouette_.With(frame, camera, MaskIdOf(masks[camera])).Run();
  }
}

std::int64_t FrameInserter::MaskIdOf(const core::SoftMask& mask) {
  const MaskHash hash = HashOf(mask);
  const std::span<const std::byte> content_hash(hash);
  if (find_mask_.With(content_hash).Next()) return LastRowsId(find_mask_);
  const PackedMask packed = Pack(mask, compressor_);
  insert_mask_.With(content_hash, mask.mask.width_px(), mask.mask.height_px(), mask.mask.CountObjectPixels(),
                    packed.words_zstd, packed.levels_zstd);
  core::Require(insert_mask_.Next(), "SQLite returns the id of a row that it inserts");
  return LastRowsId(insert_mask_);
}

void FrameInserter::InsertPart(core::FrameIndex frame, const core::PartContact& contact) {
  insert_part_frame_
      .With(frame, contact.part, core::ToString(contact.verdict), contact.resolution_mm,
            contact.count.triangles, contact.count.queries, contact.count.skipped)
      .Run();
  if (HasContactRow(contact)) InsertEvidence(frame, contact);
  if (contact.clearance) InsertClearance(frame, contact);
}

void FrameInserter::InsertEvidence(core::FrameIndex frame, const core::PartContact& contact) {
  using Point = std::optional<Eigen::Vector3d>;
  using Number = std::optional<double>;
  const auto& deepest = contact.deepest;
  const auto& recovery = contact.recovery;
  insert_contact_
      .With(frame, contact.part, contact.contact_area_mm2, contact.contact_point_count,
            deepest ? Point(deepest->position_in_world_mm) : Point(),
            deepest ? Number(deepest->depth_mm) : Number(), deepest ? Number(deepest->area_mm2) : Number(),
            core::ToString(contact.recovery_status), recovery ? Point(recovery->cp_obj_in_world_mm) : Point(),
            recovery ? Point(recovery->cp_hull_in_world_mm) : Point(),
            recovery ? Point(recovery->v_rec_in_world) : Point(),
            recovery ? Number(recovery->d_rec_mm) : Number(), recovery ? recovery->n_hull_in_world : Point(),
            recovery ? recovery->angle_rad : Number())
      .Run();
  for (std::size_t i = 0; i < contact.points.size(); ++i) {
    const core::ContactPoint& point = contact.points[i];
    insert_point_.With(frame, contact.part, i, point.position_in_world_mm, point.depth_mm, point.area_mm2)
        .Run();
  }
}

void FrameInserter::InsertClearance(core::FrameIndex frame, const core::PartContact& contact) {
  const core::ClearanceInterval& interval = contact.clearance->interval;
  const auto finite = [](double length_mm) {
    return std::isfinite(length_mm) ? std::optional(length_mm) : std::nullopt;
  };
  const auto witness = [&](const Eigen::Vector3d& x) {
    return contact.clearance->has_witnesses ? std::optional(x) : std::nullopt;
  };
  const std::optional<core::ErrorBudget>& budget = contact.clearance->budget;
  const auto sigma = [&](double core::ErrorBudget::*length_mm) {
    return budget ? std::optional((*budget).*length_mm) : std::nullopt;
  };
  insert_clearance_
      .With(frame, contact.part, finite(interval.lower_mm), finite(interval.upper_mm),
            witness(interval.witness_part_in_world_mm), witness(interval.witness_hull_in_world_mm),
            contact.clearance->queries, sigma(&core::ErrorBudget::calibration_mm),
            sigma(&core::ErrorBudget::footprint_mm), sigma(&core::ErrorBudget::segmentation_mm),
            sigma(&core::ErrorBudget::skew_mm), sigma(&core::ErrorBudget::given_mm))
      .Run();
}

core::FrameRecord ReadFrame(Database& database, const core::SessionHeader& header, core::FrameIndex frame) {
  const std::string where = fmt::format("session '{}', frame {}", database.path().string(), frame);
  Statement row(database, "SELECT time_s FROM frame WHERE frame_index = ?");
  if (!row.With(frame).Next())
    throw Error(ErrorKind::kRange, where + ": there is no such frame; choose a recorded one");
  core::FrameRecord record;
  record.frame = frame;
  record.time_s = Time_s(row.Real(0), where, "its time");
  record.spacing_mm = ReadSpacings(database, frame, where);
  record.masks = ReadSilhouettes(database, header.rig, frame, where);
  record.stamps = ReadStamps(database, header.rig.cameras.size(), frame, where);
  record.contacts = ReadContacts(database, header.layout.parts.size(), frame);
  record.rest_from_parts = ReadMotions(database, header.layout.parts.size(), frame, where);
  if (record.spacing_mm.size() != header.layout.spacings.size() ||
      record.masks->size() != header.rig.cameras.size() ||
      record.contacts.size() != header.layout.parts.size()) {
    FailAsDamaged(where, "rows are missing");
  }
  return record;
}

}  // namespace elbowroom::sessions
