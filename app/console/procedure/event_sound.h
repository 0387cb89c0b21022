// One of the desktop's own sounds.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace elbowroom::console {

// A sound of the freedesktop.org sound theme, played by the desktop's sound server, or by ALSA where there is
// none (libcanberra). The server is asked for on a thread of the sound's own, which begins with the first
// sound; one that went away is asked for again. Thread: any may ask.
class EventSound {
 public:
  // What came of a sound, on the sound's own thread: an empty line, or why it can't be heard. Must not throw.
  using OnPlayed = std::function<void(const std::string& trouble)>;

  // name: as the sound naming specification has it, "bell" for example.
  EventSound(std::string name, OnPlayed on_played);
  ~EventSound();
  EventSound(const EventSound&) = delete;
  EventSound& operator=(const EventSound&) = delete;

  void Play();  // returns at once; asked for again before it began, it sounds once

 private:
  void Run(const std::stop_token& stop);

  std::string name_;
  OnPlayed on_played_;
  std::mutex mutex_;
  std::condition_variable_any wakes_;
  bool is_asked_for_ = false;
  std::jthread thread_;
};

}  // namespace elbowroom::console
