#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "core/error.h"
#include "sessions/session_reader.h"
#include "sessions/session_writer.h"
#include "tests/sessions/sample_session.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

using sessions::SessionReader;
using sessions::SessionWriter;
using test_support::TemporaryFolder;

constexpr std::uint32_t kTripSeed = 11;

std::int64_t Count(const std::filesystem::path& path, const std::string& sql) {
  return SQLite::Database(path.string()).execAndGet(sql).getInt64();
}

TEST(SessionRoundTrip, HeaderComesBackExactly) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 3);
  const SessionReader reader(folder / "s.db");
  ExpectEqual(reader.header(), SampleHeader());
  EXPECT_EQ(reader.status(), sessions::SessionStatus::kComplete);
  ASSERT_TRUE(reader.ended_at_utc().has_value());
  EXPECT_EQ(reader.ended_at_utc()->size(), std::string_view("2024-03-01T09:30:00Z").size());
}

TEST(SessionRoundTrip, EveryWayOutOfTheHullComesBackExactly) {
  using enum core::RecoveryStatus;
  const TemporaryFolder folder;
  core::SessionHeader header = SampleHeader();
  const Eigen::Vector3d axis(1.0 / 3.0, -2e-9, 7.0), at(0.1, 0.2, 5e300);
  header.layout.parts[0].recovery = {core::RecoveryKind::kHinge, {}, axis, at};
  header.layout.parts[1].recovery = {core::RecoveryKind::kSlider, at, axis, {}};
  header.layout.parts[2].recovery = {core::RecoveryKind::kReference, at, {}, {}};
  std::vector<core::FrameRecord> frames;
  for (const core::RecoveryStatus status :
       {kFound, kReferenceInsideHull, kNoExit, kHullInsidePart, kOnSurface}) {
    core::FrameRecord record = SampleFrame(header, static_cast<core::FrameIndex>(frames.size()), kTripSeed);
    record.contacts[0].recovery_status = status;
    record.contacts[0].recovery->angle_rad = -1.0 / 3.0;
    frames.push_back(std::move(record));
  }
  {
    SessionWriter writer(folder / "s.db", header);
    for (const core::FrameRecord& frame : frames) writer.Append(frame);
    writer.Finish({});
  }
  const SessionReader reader(folder / "s.db");
  ExpectEqual(reader.header(), header);
  for (const core::FrameRecord& frame : frames) ExpectEqual(reader.ReadFrame(frame.frame), frame);
}

TEST(SessionRoundTrip, StampsComeBackExactlyAndAMissingCameraStaysMissing) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  std::vector<core::FrameRecord> frames;
  for (core::FrameIndex i = 0; i < 4; ++i) frames.push_back(SampleFrame(header, i, kTripSeed));
  frames[1].stamps = {core::CameraStamp{std::uint64_t{1} << 62U, 1.0 / 3.0}, std::nullopt};
  frames[2].stamps = {std::nullopt, std::nullopt};
  frames[3].stamps = {};
  {
    SessionWriter writer(folder / "s.db", header);
    for (const core::FrameRecord& frame : frames) writer.Append(frame);
    writer.Finish({});
  }
  const SessionReader reader(folder / "s.db");
  for (const core::FrameRecord& frame : frames) ExpectEqual(reader.ReadFrame(frame.frame), frame);
  const std::vector<sessions::StampRow> stamped = reader.stamp_rows();
  ASSERT_EQ(stamped.size(), 3U);
  for (std::size_t i = 0; i < stamped.size(); ++i) {
    EXPECT_EQ(stamped[i].frame, frames[i].frame);
    EXPECT_EQ(stamped[i].time_s, frames[i].time_s);
    EXPECT_EQ(stamped[i].stamps, frames[i].stamps);
  }
}

TEST(SessionRoundTrip, AStampThatNoCameraGivesIsRefused) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  SessionWriter writer(folder / "s.db", header);
  core::FrameRecord record = SampleFrame(header, 0, kTripSeed);
  const auto refuses = [&](std::vector<std::optional<core::CameraStamp>> stamps) {
    record.stamps = std::move(stamps);
    EXPECT_THROW(writer.Append(record), core::PreconditionError);
  };
  refuses({core::CameraStamp{1, 0.0}});
  refuses({core::CameraStamp{std::uint64_t{1} << 63U, 0.0}, std::nullopt});
  refuses({core::CameraStamp{1, std::nan("")}, std::nullopt});
}

TEST(SessionRoundTrip, EqualMeshesAreKeptOnceInTheFileAndInMemory) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 1);
  EXPECT_EQ(Count(folder / "s.db", "SELECT count(*) FROM mesh"), 2);
  const SessionReader reader(folder / "s.db");
  EXPECT_EQ(reader.header().layout.parts[0].mesh, reader.header().layout.parts[2].mesh);
}

TEST(SessionRoundTrip, EveryFrameComesBackExactlyInAnyOrder) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  constexpr core::FrameIndex kFirst = 100, kFrames = 40;
  {
    SessionWriter writer(folder / "s.db", header);
    for (core::FrameIndex i = 0; i < kFrames; ++i) writer.Append(SampleFrame(header, kFirst + i, kTripSeed));
    writer.Finish({});
    EXPECT_EQ(writer.frames_committed(), kFrames);
  }
  const SessionReader reader(folder / "s.db");
  ASSERT_EQ(reader.frame_count(), kFrames);
  for (core::FrameIndex i = kFrames - 1; i >= 0; --i) {
    ExpectEqual(reader.ReadFrame(kFirst + i), SampleFrame(header, kFirst + i, kTripSeed));
  }
  const std::vector<sessions::FrameSummary> frames = reader.frames();
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(frames.front().frame, kFirst);
  EXPECT_EQ(frames.front().time_s, SampleFrame(header, kFirst, kTripSeed).time_s);
  EXPECT_EQ(frames.front().spacing_mm, (std::vector<double>{240.0, 0.1}));
}

TEST(SessionRoundTrip, EvidenceOfAnUndecidedPartIsKeptButIsNoContact) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  core::FrameRecord record = SampleFrame(header, 0, kTripSeed);
  for (core::PartContact& contact : record.contacts) contact.verdict = core::Verdict::kUndecided;
  {
    SessionWriter writer(folder / "s.db", header);
    writer.Append(record);
    writer.Finish({});
  }
  const SessionReader reader(folder / "s.db");
  ExpectEqual(reader.ReadFrame(0), record);
  EXPECT_TRUE(reader.contacts().empty());
  EXPECT_EQ(Count(folder / "s.db", "SELECT count(*) FROM v_contact"), 0);
}

TEST(SessionRoundTrip, ARepeatedSilhouetteIsStoredOnce) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  {
    SessionWriter writer(folder / "s.db", header);
    core::FrameRecord record = SampleFrame(header, 0, kTripSeed);
    for (; record.frame < 20; ++record.frame) writer.Append(record);
    writer.Finish({});
  }
  EXPECT_EQ(Count(folder / "s.db", "SELECT count(*) FROM silhouette"), 40);
  EXPECT_EQ(Count(folder / "s.db", "SELECT count(*) FROM mask"), 2);
}

TEST(SessionRoundTrip, EqualPixelsWithOtherLevelsOrNoneStayApart) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  core::FrameRecord soft = SampleFrame(header, 0, kTripSeed);
  ASSERT_GT((*soft.masks)[0].levels.size(), 20U);
  core::FrameRecord ready = AsOfSchema(1, soft), other = soft;
  std::vector<core::SoftMask> masks = *soft.masks;
  masks[0].levels.back() ^= 1U;
  other.masks = std::make_shared<const std::vector<core::SoftMask>>(std::move(masks));
  soft.frame = 0, other.frame = 1, ready.frame = 2;
  {
    SessionWriter writer(folder / "s.db", header);
    for (const core::FrameRecord& record : {soft, other, ready}) writer.Append(record);
    writer.Finish({});
  }
  const SessionReader reader(folder / "s.db");
  for (const core::FrameRecord& record : {soft, other, ready})
    ExpectEqual(reader.ReadFrame(record.frame), record);
  EXPECT_EQ(Count(folder / "s.db", "SELECT count(*) FROM mask"), 4);
  EXPECT_EQ(Count(folder / "s.db", "SELECT count(*) FROM mask WHERE levels_zstd IS NULL"), 2);
}

TEST(SessionRoundTrip, MasksOfEqualWordsAndDifferentSizesStayApart) {
  const TemporaryFolder folder;
  core::SessionHeader header = SampleHeader();
  core::CameraCalibration wider = header.rig.cameras[1].calibration();
  wider.image_width_px = 129;  // as many words a row as 130
  header.rig.cameras[1] = core::CameraModel(wider);
  core::FrameRecord record = SampleFrame(header, 0, kTripSeed);
  record.masks = std::make_shared<const std::vector<core::SoftMask>>(
      std::vector<core::SoftMask>{{core::BitMask(130, 97), {}}, {core::BitMask(129, 97), {}}});
  {
    SessionWriter writer(folder / "s.db", header);
    writer.Append(record);
    writer.Finish({});
  }
  ExpectEqual(SessionReader(folder / "s.db").ReadFrame(0), record);
}

TEST(SessionRoundTrip, EventsKeepTheirOrder) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 8);
  EXPECT_EQ(SessionReader(folder / "s.db").events(), SampleEvents());
}

TEST(SessionRoundTrip, TheOutcomeComesBackExactly) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 8);
  const SessionReader reader(folder / "s.db");
  const core::SessionOutcome expected = SampleOutcome(0, 7);
  ASSERT_EQ(reader.episodes().size(), expected.episodes.size());
  for (std::size_t i = 0; i < expected.episodes.size(); ++i)
    ExpectEqual(reader.episodes()[i], expected.episodes[i]);
  ASSERT_EQ(reader.near_misses().size(), 1U);
  ExpectEqual(reader.near_misses()[0], expected.near_misses[0]);
  ASSERT_EQ(reader.heat_maps().size(), 1U);
  const core::HeatMap map = reader.heat_maps()[0];
  EXPECT_EQ(map.part, 0U);
  EXPECT_EQ(map.patch_mm, core::kHeatPatchMm);
  EXPECT_EQ(map.dwell_s, expected.heat_maps[0].dwell_s);
  EXPECT_EQ(map.peak_depth_mm, expected.heat_maps[0].peak_depth_mm);
}

TEST(SessionRoundTrip, ContactRowsAndTotalsAgreeWithTheFrames) {
  const TemporaryFolder folder;
  constexpr core::FrameIndex kFrames = 7;
  WriteSampleSession(folder / "s.db", kFrames);
  const SessionReader reader(folder / "s.db");
  const std::vector<sessions::ContactRow> rows = reader.contacts();
  ASSERT_EQ(rows.size(), 14U);  // two of the three parts in every frame
  for (std::size_t i = 0; i < rows.size(); ++i) {
    core::FrameRecord record = reader.ReadFrame(rows[i].frame);
    core::PartContact& expected = record.contacts[i % 2];
    expected.points.clear();
    EXPECT_EQ(rows[i].frame, static_cast<core::FrameIndex>(i / 2));
    EXPECT_EQ(rows[i].time_s, record.time_s);
    EXPECT_EQ(rows[i].spacing_mm, record.spacing_mm);
    ExpectEqual(rows[i].contact, expected);
  }
  const std::vector<sessions::ContactRow> clearances = reader.clearances();
  ASSERT_EQ(clearances.size(), 14U);  // again two of the three, and another two
  for (std::size_t i = 0; i < clearances.size(); ++i) {
    core::PartContact expected = reader.ReadFrame(clearances[i].frame).contacts[i % 2 == 0 ? 0 : 2];
    expected.points.clear();
    ExpectEqual(clearances[i].contact, expected);
  }
  const std::vector<sessions::PartTotals> totals = reader.part_totals();
  ASSERT_EQ(totals.size(), 3U);
  EXPECT_EQ(totals[0].frames_in_contact, kFrames);
  EXPECT_EQ(totals[2].frames_in_contact, 0);
  EXPECT_EQ(totals[2].frames_near, 3);
  EXPECT_EQ(totals[2].frames_undecided, 2);
  EXPECT_EQ(totals[2].frames_clear, 2);
}

TEST(SessionRoundTrip, SeveralThreadsAppendAtOnce) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  constexpr core::FrameIndex kFramesPerThread = 60;
  constexpr int kThreads = 3;
  {
    SessionWriter writer(folder / "s.db", header);
    std::vector<std::jthread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&, t] {
        for (core::FrameIndex i = t; i < kFramesPerThread * kThreads; i += kThreads) {
          writer.Append(SampleFrame(header, i, kTripSeed));
          writer.Append(core::SessionEvent{i, 0.0, core::Note{"thread " + std::to_string(t)}});
        }
      });
    }
    threads.clear();
    writer.Finish({});
  }
  const SessionReader reader(folder / "s.db");
  ASSERT_EQ(reader.frame_count(), kFramesPerThread * kThreads);
  EXPECT_EQ(reader.events().size(), static_cast<std::size_t>(kFramesPerThread * kThreads));
  for (core::FrameIndex i = 0; i < reader.frame_count(); i += 7) {
    ExpectEqual(reader.ReadFrame(i), SampleFrame(header, i, kTripSeed));
  }
}

}  // namespace
}  // namespace elbowroom::tests
