#include "sessions/bcf/bcf_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <pugixml.hpp>
#include <set>

#include "core/error.h"
#include "tests/sessions/bcf/zip_entries.h"
#include "tests/sessions/expect_error.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::tests {
namespace {

using core::ErrorKind;
using sessions::BcfTopic;
using sessions::PackBcf;
using sessions::ReadBcfFile;

BcfTopic Sample(char digit, const std::string& text) {
  BcfTopic topic;
  topic.id = std::string(32, digit);
  topic.title = text;
  topic.type = "Clash";
  topic.status = "Active";
  topic.description = text;
  topic.labels = {text, "touch"};
  topic.created_at_utc = "2024-03-02T10:00:00Z";
  topic.created_by = "elbowroom";
  topic.modified_at_utc = "2024-03-03T10:00:00Z";
  topic.modified_by = text;
  topic.comments = {{std::string(32, 'c'), "2024-03-03T09:00:00Z", text, text}};
  topic.components = {text, "what is real"};
  topic.camera = sessions::TopicCamera{
      {1000.0, -500.0, 250.0}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(), 45.0};
  topic.cut = sessions::TopicCut{{1000.0, 300.0, 250.0}, -Eigen::Vector3d::UnitY()};
  topic.snapshot_png = {0x89, 'P', 'N', 'G'};
  return topic;
}

// What the standard says of an element: its children, in this order; '*': any number of them, '?': one or
// none.
void ExpectSequence(const pugi::xml_node& node, const std::vector<std::string>& wanted) {
  auto child = node.first_child();
  for (const std::string& entry : wanted) {
    const char last = entry.back();
    const std::string name = last == '*' || last == '?' ? entry.substr(0, entry.size() - 1) : entry;
    int count = 0;
    for (; child && name == child.name(); child = child.next_sibling()) ++count;
    const bool is_optional = last == '*' || last == '?';
    EXPECT_GE(count, is_optional ? 0 : 1) << node.name() << "/" << name;
    EXPECT_TRUE(count <= 1 || last == '*') << node.name() << "/" << name;
  }
  EXPECT_FALSE(child) << node.name() << " has " << child.name() << " where it must not";
}

void ExpectMarkupAsTheStandardSays(const std::string& xml) {
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(xml.c_str()));
  const auto markup = document.child("Markup");
  ExpectSequence(markup, {"Header?", "Topic", "Comment*", "Viewpoints*"});
  ExpectSequence(markup.child("Topic"),
                 {"ReferenceLink*", "Title", "Priority?", "Index?", "Labels*", "CreationDate",
                  "CreationAuthor", "ModifiedDate?", "ModifiedAuthor?", "DueDate?", "AssignedTo?", "Stage?",
                  "Description?", "BimSnippet*", "DocumentReference*", "RelatedTopic*"});
  for (const auto comment : markup.children("Comment"))
    ExpectSequence(comment, {"Date", "Author", "Comment", "Viewpoint?", "ModifiedDate?", "ModifiedAuthor?"});
  for (const auto viewpoint : markup.children("Viewpoints"))
    ExpectSequence(viewpoint, {"Viewpoint?", "Snapshot?", "Index?"});
}

void ExpectViewpointAsTheStandardSays(const std::string& xml) {
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(xml.c_str()));
  const auto info = document.child("VisualizationInfo");
  EXPECT_TRUE(info.attribute("Guid"));
  ExpectSequence(info,
                 {"Components?", "OrthogonalCamera?", "PerspectiveCamera?", "Lines?", "ClippingPlanes?"});
  ExpectSequence(info.child("Components"), {"ViewSetupHints?", "Selection?", "Visibility", "Coloring?"});
  const auto camera = info.child("PerspectiveCamera");
  ExpectSequence(camera, {"CameraViewPoint", "CameraDirection", "CameraUpVector", "FieldOfView"});
  for (const auto part : camera.children())
    if (std::string(part.name()) != "FieldOfView") ExpectSequence(part, {"X", "Y", "Z"});
  for (const auto plane : info.child("ClippingPlanes").children()) {
    ExpectSequence(plane, {"Location", "Direction"});
    for (const auto part : plane.children()) ExpectSequence(part, {"X", "Y", "Z"});
  }
}

const std::string kHostile = std::string(
                                 "<script>alert(1)</script> \"quotes\" '&' ]]> =cmd|' /C calc'!A0 "
                                 "\xE2\x80\xAEright to left\x01\x1b ") +
                             std::string(10'000, 'x') + "\xEF\xBF\xBF\xFF";

TEST(BcfFile, HasTheFormOfTheStandard) {
  const test_support::TemporaryFolder folder;
  test_support::WriteText(folder / "t.bcfzip",
                          PackBcf(std::vector{Sample('a', "Payload A"), Sample('b', kHostile)}));
  const auto entries = ZipEntries(folder / "t.bcfzip");
  ASSERT_EQ(entries.size(), 7U);
  EXPECT_THAT(entries.at("bcf.version"), testing::HasSubstr("VersionId=\"2.1\""));
  for (const std::string guid :
       {"aaaaaaaa-aaaa-aaaa-aaaa-aaaaaaaaaaaa", "bbbbbbbb-bbbb-bbbb-bbbb-bbbbbbbbbbbb"}) {
    ExpectMarkupAsTheStandardSays(entries.at(guid + "/markup.bcf"));
    ExpectViewpointAsTheStandardSays(entries.at(guid + "/viewpoint.bcfv"));
    EXPECT_THAT(entries.at(guid + "/markup.bcf"), testing::HasSubstr("Guid=\"" + guid));
  }
  EXPECT_EQ(entries.at("aaaaaaaa-aaaa-aaaa-aaaa-aaaaaaaaaaaa/snapshot.png"), "\x89PNG");
}

// With the schemas that buildingSMART publishes, where they lie on this machine.
TEST(BcfFile, IsValidAgainstThePublishedSchemas) {
  const char* schemas = std::getenv("ELBOWROOM_BCF_SCHEMAS");
  if (schemas == nullptr)
    GTEST_SKIP()
        << "set ELBOWROOM_BCF_SCHEMAS to a folder with markup.xsd, visinfo.xsd and version.xsd of BCF 2.1";
  const test_support::TemporaryFolder folder;
  test_support::WriteText(folder / "t.bcfzip", PackBcf(std::vector{Sample('a', kHostile)}));
  for (const auto& [name, content] : ZipEntries(folder / "t.bcfzip")) {
    const std::filesystem::path file = folder / std::filesystem::path(name).filename();
    test_support::WriteText(file, content);
    const std::string ending = file.extension();
    if (ending == ".png") continue;
    const char* schema = ending == ".bcfv"      ? "visinfo.xsd"
                         : ending == ".version" ? "version.xsd"
                                                : "markup.xsd";
    const auto run = test_support::RunProgram(
        "/usr/bin/xmllint",
        {"--noout", "--schema", (std::filesystem::path(schemas) / schema).string(), file.string()});
    EXPECT_EQ(run.exit_status, 0) << run.err;
  }
}

TEST(BcfFile, KeepsEveryTextAsItIs) {
  const test_support::TemporaryFolder folder;
  test_support::WriteText(folder / "t.bcfzip", PackBcf(std::vector{Sample('a', kHostile)}));
  const std::vector<BcfTopic> back = ReadBcfFile(folder / "t.bcfzip");
  ASSERT_EQ(back.size(), 1U);
  // XML has no such characters, and the last byte isn't UTF-8.
  std::string expected = kHostile;
  for (const std::string wrong : {"\x01", "\x1b", "\xEF\xBF\xBF", "\xFF"})
    expected.replace(expected.find(wrong), wrong.size(), "\xEF\xBF\xBD");
  EXPECT_EQ(back[0].title, expected);
  EXPECT_EQ(back[0].comments[0].text, expected);
  EXPECT_EQ(back[0].comments[0].author, expected);
  EXPECT_EQ(back[0].id, std::string(32, 'a'));
  EXPECT_EQ(back[0].status, "Active");
  EXPECT_EQ(back[0].modified_at_utc, "2024-03-03T10:00:00Z");
}

TEST(BcfFile, IsTheSameForTheSameTopics) {
  EXPECT_EQ(PackBcf(std::vector{Sample('a', "x")}), PackBcf(std::vector{Sample('a', "x")}));
}

TEST(BcfFile, SaysLengthsInMetres) {
  const test_support::TemporaryFolder folder;
  test_support::WriteText(folder / "t.bcfzip", PackBcf(std::vector{Sample('a', "x")}));
  pugi::xml_document document;
  document.load_string(
      ZipEntries(folder / "t.bcfzip").at("aaaaaaaa-aaaa-aaaa-aaaa-aaaaaaaaaaaa/viewpoint.bcfv").c_str());
  const auto eye = document.child("VisualizationInfo").child("PerspectiveCamera").child("CameraViewPoint");
  EXPECT_EQ(eye.child("X").text().as_double(), 1.0);
  EXPECT_EQ(eye.child("Y").text().as_double(), -0.5);
  const auto plane = document.child("VisualizationInfo").child("ClippingPlanes").child("ClippingPlane");
  EXPECT_EQ(plane.child("Location").child("Y").text().as_double(), 0.3);
  EXPECT_EQ(plane.child("Direction").child("Y").text().as_double(), -1.0);
}

TEST(BcfFile, RefusesWhatIsNoSuchFile) {
  const test_support::TemporaryFolder folder;
  ExpectError([&] { (void)ReadBcfFile(folder / "none.bcfzip"); }, ErrorKind::kFile, "none.bcfzip");
  test_support::WriteText(folder / "text.bcfzip", std::string(1000, 'x'));
  ExpectError([&] { (void)ReadBcfFile(folder / "text.bcfzip"); }, ErrorKind::kFormat, "no zip");
  WriteZip(folder / "other.zip", {{"a.txt", "a"}});
  ExpectError([&] { (void)ReadBcfFile(folder / "other.zip"); }, ErrorKind::kFormat, "bcf.version");
  WriteZip(folder / "new.bcf", {{"bcf.version", "<Version VersionId=\"3.0\"/>"}});
  ExpectError([&] { (void)ReadBcfFile(folder / "new.bcf"); }, ErrorKind::kFormat, "version '3.0'");
  WriteZip(folder / "broken.bcf",
           {{"bcf.version", "<Version VersionId=\"2.1\"/>"}, {"x/markup.bcf", "<Markup><Topic"}});
  ExpectError([&] { (void)ReadBcfFile(folder / "broken.bcf"); }, ErrorKind::kFormat, "x/markup.bcf");
  WriteZip(folder / "bomb.bcf",
           {{"bcf.version", "<Version VersionId=\"2.1\"/>"}, {"x/markup.bcf", std::string(100 << 20, ' ')}});
  ExpectError([&] { (void)ReadBcfFile(folder / "bomb.bcf"); }, ErrorKind::kFormat, "which no markup has");
}

TEST(BcfFile, NeverFallsOverDamage) {
  const test_support::TemporaryFolder folder;
  const std::string whole = PackBcf(std::vector{Sample('a', "Payload A"), Sample('b', "PMT")});
  for (std::size_t i = 0; i < whole.size(); i += 7) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
    test_support::WriteText(folder / "d.bcfzip", i % 2 == 0 ? damaged : whole.substr(0, i));
    try {
      (void)ReadBcfFile(folder / "d.bcfzip");
    } catch (const core::Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("d.bcfzip"));
    }
  }
}

}  // namespace
}  // namespace elbowroom::tests
