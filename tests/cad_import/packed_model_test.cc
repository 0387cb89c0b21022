#include "cad_import/packed_model.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "core/error.h"
#include "tests/cad_import/error_of.h"
#include "tests/core/solids.h"
#include "tests/support/soak.h"

namespace elbowroom::cad_import {
namespace {

using core::ErrorKind;
using testing::ErrorOf;
using testing::Mentions;
using Bytes = std::vector<std::byte>;

CadModel SampleModel() {
  CadModel model;
  core::TriangleMesh box = core::testing::Box({10, 20, 30});
  box.deviation_mm = 0.125;
  model.shapes.push_back({"box",
                          std::make_shared<const core::TriangleMesh>(std::move(box)),
                          {{"lower", 0, 8}, {"upper", 8, 4}},
                          {.watertight = true, .turned = 3}});
  model.instances.push_back(
      {"rack/box", 0, {Eigen::Matrix3d::Identity(), {1, 2, 3}}, ColorRgb{0.25F, 0.5F, 1.0F}});
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  model.instances.push_back({"rack/box 2", 0, {turned, {-5, 0, 7}}, std::nullopt});
  model.report = {.parts = 4,
                  .triangles = 24,
                  .unit = "in",
                  .bounds_mm = {Eigen::Vector3d(-1, -2, -3), Eigen::Vector3d(4, 5, 6)},
                  .watertight = true,
                  .repaired = true,
                  .dropped_triangles = 7,
                  .deviation_mm = 0.125,
                  .warnings = {"one", "two"}};
  return model;
}

const std::vector<ReferredFile> kReferred = {{"buffers/a.bin", std::string(32, 'f')}};

TEST(PackedModel, ComesBackAsItWas) {
  const CadModel model = SampleModel();
  const PackedModel back = Unpack(Pack(model, kReferred), "test");
  ASSERT_EQ(back.model.shapes.size(), 1U);
  EXPECT_EQ(*back.model.shapes[0].mesh, *model.shapes[0].mesh);
  EXPECT_EQ(back.model.shapes[0].name, "box");
  EXPECT_EQ(back.model.shapes[0].pieces, model.shapes[0].pieces);
  EXPECT_EQ(back.model.shapes[0].surface, model.shapes[0].surface);
  ASSERT_EQ(back.model.instances.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back.model.instances[i].path, model.instances[i].path);
    EXPECT_EQ(back.model.instances[i].model_from_shape.rotation,
              model.instances[i].model_from_shape.rotation);
    EXPECT_EQ(back.model.instances[i].model_from_shape.translation_mm,
              model.instances[i].model_from_shape.translation_mm);
    EXPECT_EQ(back.model.instances[i].color, model.instances[i].color);
  }
  const ImportReport &got = back.model.report, &want = model.report;
  EXPECT_EQ(got.unit, want.unit);
  EXPECT_EQ(got.is_unit_stated, want.is_unit_stated);
  EXPECT_EQ(got.bounds_mm.min(), want.bounds_mm.min());
  EXPECT_EQ(got.bounds_mm.max(), want.bounds_mm.max());
  EXPECT_EQ(got.dropped_triangles, want.dropped_triangles);
  EXPECT_EQ(got.deviation_mm, want.deviation_mm);
  EXPECT_EQ(got.warnings, want.warnings);
  ASSERT_EQ(back.referred.size(), 1U);
  EXPECT_EQ(back.referred[0].path, "buffers/a.bin");
}

TEST(PackedModel, CutOffAnywhereIsAnError) {
  const Bytes whole = Pack(SampleModel(), kReferred);
  for (std::size_t size = 0; size < whole.size(); ++size)
    (void)ErrorOf(ErrorKind::kFormat, [&] { (void)Unpack(std::span(whole).first(size), "test"); });
  Bytes longer = whole;
  longer.push_back(std::byte{0});
  (void)ErrorOf(ErrorKind::kFormat, [&] { (void)Unpack(longer, "test"); });
}

TEST(PackedModel, AnyChangedByteIsAnError) {
  const Bytes whole = Pack(SampleModel(), kReferred);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    Bytes changed = whole;
    changed[i] ^= std::byte{0x10};
    EXPECT_THROW((void)Unpack(changed, "test"), core::Error) << "byte " << i;
  }
}

// A wrong child can make the checksum right; every later check must hold alone.
TEST(PackedModel, LiesWithARightChecksumAreErrorsOrValidModels) {
  const Bytes whole = Pack(SampleModel(), kReferred);
  constexpr std::size_t kChecksumAt = 12, kPayloadAt = 20;
  std::mt19937 random(1407);
  int refused = 0;
  const int trials = 20'000 * test_support::SoakScale();
  for (int trial = 0; trial < trials; ++trial) {
    Bytes changed = whole;
    for (int i = 0, count = 1 + static_cast<int>(random() % 3); i < count; ++i)
      changed[kPayloadAt + random() % (changed.size() - kPayloadAt)] = static_cast<std::byte>(random());
    if (random() % 4 == 0) changed.resize(kPayloadAt + random() % (changed.size() - kPayloadAt));
    const std::uint64_t checksum = ChecksumOf(std::span(changed).subspan(kPayloadAt));
    std::memcpy(changed.data() + kChecksumAt, &checksum, sizeof checksum);
    try {
      const PackedModel back = Unpack(changed, "test");
      for (const CadShape& shape : back.model.shapes) core::ValidateMesh(*shape.mesh, "test");
      for (const CadInstance& instance : back.model.instances)
        ASSERT_LT(instance.shape, back.model.shapes.size());
    } catch (const core::Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, trials / 4);
}

TEST(PackedModel, AnotherVersionIsNamed) {
  Bytes bytes = Pack(SampleModel(), {});
  bytes[8] = std::byte{99};
  EXPECT_TRUE(
      Mentions(ErrorOf(ErrorKind::kFormat, [&] { (void)Unpack(bytes, "test"); }), "of another version"));
}

}  // namespace
}  // namespace elbowroom::cad_import
