// The XML files within a BCF file.
#pragma once

#include <string>
#include <string_view>

#include "sessions/bcf/bcf_topic.h"

namespace elbowroom::sessions {

// "0123abcd..." as "0123abcd-....-....-....-............".
[[nodiscard]] std::string GuidFrom(std::string_view id);

// The one viewpoint of a topic.
[[nodiscard]] std::string ViewpointGuid(const BcfTopic& topic);

[[nodiscard]] std::string VersionXml();                         // bcf.version
[[nodiscard]] std::string MarkupXml(const BcfTopic& topic);     // markup.bcf
[[nodiscard]] std::string ViewpointXml(const BcfTopic& topic);  // viewpoint.bcfv; the topic has a camera

// A topic from its markup.bcf. Throws: Error{kFormat} naming `where`.
[[nodiscard]] BcfTopic TopicFromXml(std::string_view xml, const std::string& where);

// "2.1" from bcf.version. Throws: Error{kFormat} naming `where`.
[[nodiscard]] std::string VersionFromXml(std::string_view xml, const std::string& where);

}  // namespace elbowroom::sessions
