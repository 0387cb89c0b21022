// A topic of a BCF file: what reviewers of a CAD team work off.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace elbowroom::sessions {

// From where the topic is to be looked at, in world.
struct TopicCamera {
  Eigen::Vector3d eye_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  // of length 1
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();         // of length 1, at right angles to it
  double vertical_fov_deg = 45.0;                        // BCF 2.1 takes 45 to 60
};

// A plane beyond which nothing is shown, in world.
struct TopicCut {
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_hidden = Eigen::Vector3d::UnitZ();  // of length 1, into what isn't shown
};

struct TopicComment {
  std::string id;      // 32 hex digits
  std::string at_utc;  // ISO 8601
  std::string author;
  std::string text;
};

struct BcfTopic {
  std::string id;  // 32 hex digits, lower case: in a BCF file a Guid
  std::string title;
  std::string type;
  std::string status;
  std::string description;
  std::vector<std::string> labels;
  std::string created_at_utc;
  std::string created_by;
  std::string modified_at_utc;  // empty: never
  std::string modified_by;
  std::vector<TopicComment> comments;
  std::vector<std::string> components;  // by name: what touches what
  std::optional<TopicCamera> camera;
  std::optional<TopicCut> cut;              // only with a camera
  std::vector<unsigned char> snapshot_png;  // empty: none
};

}  // namespace elbowroom::sessions
