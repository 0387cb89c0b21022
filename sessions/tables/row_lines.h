// Rows of a session as lines of a file, made on a thread of their own.
#pragma once

#include <functional>
#include <future>
#include <string>
#include <vector>

#include "core/bounded_queue.h"
#include "core/system/whole_file.h"
#include "sessions/recorded_contacts.h"

namespace elbowroom::sessions {

// While rows are read, the ones before become text. Thread: one.
class RowLines {
 public:
  using LineOf = std::function<std::string(const ContactRow&)>;

  // The file must outlive it; nobody else may write to it before Finish().
  RowLines(core::PendingFile* file, LineOf line_of);
  ~RowLines();
  RowLines(const RowLines&) = delete;
  RowLines& operator=(const RowLines&) = delete;

  void Add(const ContactRow& row);

  // All lines are in the file. Throws: what PendingFile::Append throws. To be called once, after the last
  // row.
  void Finish();

 private:
  std::vector<ContactRow> batch_;
  core::BoundedQueue<std::vector<ContactRow>> batches_;
  std::future<void> writing_;  // last: its thread uses all others
};

}  // namespace elbowroom::sessions
