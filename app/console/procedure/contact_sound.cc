#include "app/console/procedure/contact_sound.h"

#include <QSettings>

namespace elbowroom::console {
namespace {

constexpr const char* kKey = "trial/contact_sound";
constexpr const char* kSoundName = "bell";

}  // namespace

ContactSound::ContactSound(QObject* parent)
    : QObject(parent),
      is_on_(QSettings().value(kKey, false).toBool()),
      sound_(kSoundName, [this](const std::string& trouble) {
        bridge_.Post([this, line = QString::fromStdString(trouble)] { emit Played(line); });
      }) {}

void ContactSound::SetOn(bool is_on) {
  is_on_ = is_on;
  QSettings().setValue(kKey, is_on);
  if (is_on) Sound();
}

void ContactSound::Open() { was_touched_.clear(); }

void ContactSound::ShowFrame(const std::vector<core::PartContact>& contacts) {
  was_touched_.resize(contacts.size(), false);
  bool is_new = false;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const bool is_touched = contacts[i].verdict == core::Verdict::kContact;
    is_new = is_new || (is_touched && !was_touched_[i]);
    was_touched_[i] = is_touched;
  }
  if (is_on_ && is_new) Sound();
}

void ContactSound::Sound() {
  sound_.Play();
  emit Sounded();
}

}  // namespace elbowroom::console
