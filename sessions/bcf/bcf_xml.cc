#include "sessions/bcf/bcf_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <sstream>

#include "core/error.h"
#include "core/findings/finding.h"
#include "sessions/database/damage.h"

namespace elbowroom::sessions {
namespace {

using pugi::xml_node;

constexpr double kMmPerMetre = 1000.0;
constexpr const char* kSystem = "elbowroom";
constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

// XML 1.0 has no control characters but tab and the line's ends, and neither U+FFFE nor U+FFFF.
std::string XmlText(const std::string& text) {
  const std::string utf8 = AsUtf8(text);
  std::string clean;
  for (std::size_t i = 0; i < utf8.size(); ++i) {
    const auto byte = static_cast<unsigned char>(utf8[i]);
    const std::string_view three = std::string_view(utf8).substr(i, 3);
    if (three == "\xEF\xBF\xBE" || three == "\xEF\xBF\xBF") {
      clean += kReplacement;
      i += 2;
    } else if (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') {
      clean += kReplacement;
    } else {
      clean += utf8[i];
    }
  }
  return clean;
}

// "2024-03-02T10:00:00Z", or with a fraction or an offset instead of the Z.
bool IsDateTime(const std::string& text) {
  constexpr std::string_view kShape = "dddd-dd-ddTdd:dd:dd";
  if (text.size() < kShape.size() || text.size() > 40) return false;
  for (std::size_t i = 0; i < kShape.size(); ++i) {
    const bool is_digit = text[i] >= '0' && text[i] <= '9';
    if (kShape[i] == 'd' ? !is_digit : text[i] != kShape[i]) return false;
  }
  return std::ranges::all_of(text.substr(kShape.size()), [](char c) {
    return (c >= '0' && c <= '9') || c == '.' || c == 'Z' || c == '+' || c == '-' || c == ':';
  });
}

std::string DateTime(const std::string& text) { return IsDateTime(text) ? text : "1970-01-01T00:00:00Z"; }

xml_node Add(xml_node parent, const char* name, const std::string& text) {
  xml_node node = parent.append_child(name);
  node.text().set(XmlText(text).c_str());
  return node;
}

void AddVector(xml_node parent, const char* name, const Eigen::Vector3d& v) {
  xml_node node = parent.append_child(name);
  Add(node, "X", fmt::format("{}", v.x()));
  Add(node, "Y", fmt::format("{}", v.y()));
  Add(node, "Z", fmt::format("{}", v.z()));
}

std::string TextOf(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, " ", pugi::format_indent, pugi::encoding_utf8);
  return text.str();
}

void AddComment(xml_node markup, const BcfTopic& topic, const TopicComment& said) {
  xml_node comment = markup.append_child("Comment");
  comment.append_attribute("Guid") = GuidFrom(said.id).c_str();
  Add(comment, "Date", DateTime(said.at_utc));
  Add(comment, "Author", said.author);
  Add(comment, "Comment", said.text);
  if (topic.camera) comment.append_child("Viewpoint").append_attribute("Guid") = ViewpointGuid(topic).c_str();
}

pugi::xml_document Parsed(std::string_view xml, const std::string& where) {
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(xml.data(), xml.size());
  if (!result)
    throw core::Error(core::ErrorKind::kFormat,
                      fmt::format("{}: {}; export the file again", where, result.description()));
  return document;
}

std::string IdFrom(const std::string& guid) {
  std::string id;
  for (const char c : guid) {
    if (c == '-') continue;
    id += c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return id;
}

}  // namespace

std::string GuidFrom(std::string_view id) {
  core::Require(core::IsId(id), "an id has 32 hex digits");
  return fmt::format("{}-{}-{}-{}-{}", id.substr(0, 8), id.substr(8, 4), id.substr(12, 4), id.substr(16, 4),
                     id.substr(20));
}

// Another one than the topic's, as readers may keep all in one list.
std::string ViewpointGuid(const BcfTopic& topic) {
  std::string id = topic.id;
  id.back() = id.back() == '0' ? '1' : '0';
  std::ranges::reverse(id);
  return GuidFrom(id);
}

std::string VersionXml() {
  pugi::xml_document document;
  xml_node version = document.append_child("Version");
  version.append_attribute("VersionId") = "2.1";
  Add(version, "DetailedVersion", "2.1");
  return TextOf(document);
}

std::string MarkupXml(const BcfTopic& topic) {
  pugi::xml_document document;
  xml_node markup = document.append_child("Markup");
  xml_node head = markup.append_child("Topic");
  head.append_attribute("Guid") = GuidFrom(topic.id).c_str();
  head.append_attribute("TopicType") = topic.type.c_str();
  head.append_attribute("TopicStatus") = topic.status.c_str();
  Add(head, "Title", topic.title);
  for (const std::string& label : topic.labels) Add(head, "Labels", label);
  Add(head, "CreationDate", DateTime(topic.created_at_utc));
  Add(head, "CreationAuthor", topic.created_by);
  if (!topic.modified_at_utc.empty()) {
    Add(head, "ModifiedDate", DateTime(topic.modified_at_utc));
    Add(head, "ModifiedAuthor", topic.modified_by);
  }
  Add(head, "Description", topic.description);
  for (const TopicComment& said : topic.comments) AddComment(markup, topic, said);
  if (topic.camera) {
    xml_node viewpoints = markup.append_child("Viewpoints");
    viewpoints.append_attribute("Guid") = ViewpointGuid(topic).c_str();
    Add(viewpoints, "Viewpoint", "viewpoint.bcfv");
    if (!topic.snapshot_png.empty()) Add(viewpoints, "Snapshot", "snapshot.png");
  }
  return TextOf(document);
}

std::string ViewpointXml(const BcfTopic& topic) {
  pugi::xml_document document;
  xml_node info = document.append_child("VisualizationInfo");
  info.append_attribute("Guid") = ViewpointGuid(topic).c_str();
  if (!topic.components.empty()) {
    xml_node components = info.append_child("Components");
    xml_node selection = components.append_child("Selection");
    for (const std::string& name : topic.components) {
      xml_node component = selection.append_child("Component");
      Add(component, "OriginatingSystem", kSystem);
      Add(component, "AuthoringToolId", name);
    }
    components.append_child("Visibility").append_attribute("DefaultVisibility") = true;
  }
  xml_node camera = info.append_child("PerspectiveCamera");
  AddVector(camera, "CameraViewPoint", topic.camera->eye_mm / kMmPerMetre);
  AddVector(camera, "CameraDirection", topic.camera->direction);
  AddVector(camera, "CameraUpVector", topic.camera->up);
  Add(camera, "FieldOfView", fmt::format("{}", topic.camera->vertical_fov_deg));
  if (topic.cut) {
    xml_node plane = info.append_child("ClippingPlanes").append_child("ClippingPlane");
    AddVector(plane, "Location", topic.cut->at_mm / kMmPerMetre);
    AddVector(plane, "Direction", topic.cut->to_hidden);
  }
  return TextOf(document);
}

BcfTopic TopicFromXml(std::string_view xml, const std::string& where) {
  const pugi::xml_document document = Parsed(xml, where);
  const xml_node markup = document.child("Markup"), head = markup.child("Topic");
  if (!head)
    throw core::Error(core::ErrorKind::kFormat,
                      fmt::format("{}: it has no Topic; export the file again", where));
  BcfTopic topic;
  topic.id = IdFrom(head.attribute("Guid").value());
  topic.type = head.attribute("TopicType").value();
  topic.status = head.attribute("TopicStatus").value();
  topic.title = head.child_value("Title");
  topic.description = head.child_value("Description");
  topic.created_at_utc = head.child_value("CreationDate");
  topic.created_by = head.child_value("CreationAuthor");
  topic.modified_at_utc = head.child_value("ModifiedDate");
  topic.modified_by = head.child_value("ModifiedAuthor");
  for (const xml_node comment : markup.children("Comment"))
    topic.comments.push_back({IdFrom(comment.attribute("Guid").value()), comment.child_value("Date"),
                              comment.child_value("Author"), comment.child_value("Comment")});
  return topic;
}

std::string VersionFromXml(std::string_view xml, const std::string& where) {
  return Parsed(xml, where).child("Version").attribute("VersionId").value();
}

}  // namespace elbowroom::sessions
