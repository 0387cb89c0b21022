// Which advice on the light is new, and which no longer holds.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace elbowroom::control {

// Advice is the same if only its numbers differ. It no longer holds once it wasn't given for kForgetS, so
// that light at a limit doesn't give a note with each report.
class AdviceLog {
 public:
  static constexpr double kForgetS = 60.0;

  // One camera's advice at a time; times of a camera don't fall. Returns notes: the new advice as it is, and
  // "no longer: ..." for the old.
  [[nodiscard]] std::vector<std::string> Add(const std::string& camera,
                                             const std::vector<std::string>& advice, double time_s);

  // All that was ever new, in order.
  [[nodiscard]] const std::vector<std::string>& given() const { return given_; }

 private:
  struct Standing {
    std::string text;
    double last_s = 0.0;
  };
  std::map<std::string, std::map<std::string, Standing>> standing_;  // by camera, by advice without numbers
  std::vector<std::string> given_;
};

}  // namespace elbowroom::control
