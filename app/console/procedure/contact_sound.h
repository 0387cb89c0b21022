// A short tone when a part is touched that wasn't.
#pragma once

#include <QObject>
#include <vector>

#include "app/console/procedure/event_sound.h"
#include "app/console/view/bridge.h"
#include "core/contact.h"

namespace elbowroom::console {

// Off at first, and remembered. Thread: UI.
class ContactSound : public QObject {
  Q_OBJECT

 public:
  explicit ContactSound(QObject* parent = nullptr);

  [[nodiscard]] bool is_on() const { return is_on_; }
  void SetOn(bool is_on);  // on: it sounds once, so that the operator knows it

  void Open();  // of a trial that begins: nothing is touched
  void ShowFrame(const std::vector<core::PartContact>& contacts);

 signals:
  void Sounded();                       // it is asked for
  void Played(const QString& trouble);  // what came of it: empty, or why it can't be heard

 private:
  void Sound();

  bool is_on_ = false;
  std::vector<bool> was_touched_;  // by part
  Bridge bridge_;
  EventSound sound_;  // the last member: its thread posts to the bridge
};

}  // namespace elbowroom::console
