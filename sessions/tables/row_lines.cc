#include "sessions/tables/row_lines.h"

#include <utility>

namespace elbowroom::sessions {
namespace {

constexpr std::size_t kRowsInABatch = 1024;
constexpr std::size_t kBatchesUnderWay = 4;

}  // namespace

RowLines::RowLines(core::PendingFile* file, LineOf line_of)
    : batches_(kBatchesUnderWay, core::WhenFull::kBlock) {
  writing_ = std::async(std::launch::async, [this, file, line_of = std::move(line_of)] {
    try {
      while (const auto batch = batches_.Pop())
        for (const ContactRow& row : *batch) file->Append(line_of(row));
    } catch (...) {
      batches_.Close();  // Add() must not wait for room
      throw;
    }
  });
}

RowLines::~RowLines() {
  batches_.Close();
  if (writing_.valid()) writing_.wait();
}

void RowLines::Add(const ContactRow& row) {
  batch_.push_back(row);
  if (batch_.size() == kRowsInABatch) batches_.Push(std::exchange(batch_, {}));
}

void RowLines::Finish() {
  batches_.Push(std::exchange(batch_, {}));
  batches_.Close();
  writing_.get();
}

}  // namespace elbowroom::sessions
