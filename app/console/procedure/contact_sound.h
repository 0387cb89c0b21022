// A short tone when a part is touched that wasn't.
#pragma once

#include <QObject>
#include <vector>

#include "core/contact.h"

namespace elbowroom::console {

// Off at first, and remembered. Where no sound can be made, nothing happens. Thread: UI.
class ContactSound : public QObject {
  Q_OBJECT

 public:
  explicit ContactSound(QObject* parent = nullptr);

  [[nodiscard]] bool is_on() const { return is_on_; }
  void SetOn(bool is_on);

  void Open();  // of a trial that begins: nothing is touched
  void ShowFrame(const std::vector<core::PartContact>& contacts);

 signals:
  void Sounded();  // whether it is heard or not

 private:
  bool is_on_ = false;
  std::vector<bool> was_touched_;  // by part
};

}  // namespace elbowroom::console
