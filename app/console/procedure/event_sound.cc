#include "app/console/procedure/event_sound.h"

#include <canberra.h>

#include <cstdint>
#include <memory>
#include <utility>

namespace elbowroom::console {
namespace {

struct DestroyContext {
  void operator()(ca_context* context) const { ca_context_destroy(context); }
};
using Context = std::unique_ptr<ca_context, DestroyContext>;

// libcanberra's answer; CA_SUCCESS leaves a context that is connected.
int PlayWith(Context& context, const std::string& name) {
  if (!context) {
    ca_context* made = nullptr;
    if (const int answer = ca_context_create(&made); answer != CA_SUCCESS) return answer;
    context.reset(made);
    ca_context_change_props(made, CA_PROP_APPLICATION_NAME, "Elbowroom", CA_PROP_APPLICATION_ID, "elbowroom",
                            nullptr);
  }
  constexpr std::uint32_t kAnyId = 0;
  return ca_context_play(context.get(), kAnyId, CA_PROP_EVENT_ID, name.c_str(), CA_PROP_MEDIA_ROLE, "event",
                         CA_PROP_CANBERRA_CACHE_CONTROL, "permanent", nullptr);
}

}  // namespace

EventSound::EventSound(std::string name, OnPlayed on_played)
    : name_(std::move(name)), on_played_(std::move(on_played)) {}

EventSound::~EventSound() = default;

void EventSound::Play() {
  {
    const std::lock_guard lock(mutex_);
    is_asked_for_ = true;
    if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { Run(stop); });
  }
  wakes_.notify_one();
}

void EventSound::Run(const std::stop_token& stop) {
  Context context;
  while (true) {
    {
      std::unique_lock lock(mutex_);
      if (!wakes_.wait(lock, stop, [this] { return is_asked_for_; })) return;
      is_asked_for_ = false;
    }
    int answer = PlayWith(context, name_);
    if (answer != CA_SUCCESS) {  // the server may have gone, and another may be there
      context.reset();
      answer = PlayWith(context, name_);
    }
    if (answer != CA_SUCCESS) context.reset();
    on_played_(answer == CA_SUCCESS ? std::string() : std::string(ca_strerror(answer)));
  }
}

}  // namespace elbowroom::console
