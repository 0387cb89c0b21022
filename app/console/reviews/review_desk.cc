#include "app/console/reviews/review_desk.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "app/control/keep_out/keep_out_file.h"
#include "app/control/keep_out/keep_out_job.h"
#include "app/control/report/session_report.h"
#include "core/error.h"

namespace elbowroom::console {
namespace {

QString LineOf(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    return QString::fromUtf8(error.what());
  }
}

bool IsCancelled(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const core::Error& error) {
    return error.kind() == core::ErrorKind::kCancelled;
  } catch (...) {  // any other failure
    return false;
  }
}

QString TextOf(const std::filesystem::path& path) { return QString::fromStdString(path.string()); }

}  // namespace

ReviewDesk::~ReviewDesk() {
  motion_thread_.Cancel();
  job_thread_.Cancel();
}

void ReviewDesk::RunJob(Work work, std::function<void()> on_done) {
  is_busy_ = true;
  const std::int64_t job = ++jobs_;
  const core::Progress progress([this, job](std::int64_t done, std::int64_t total, const std::string& what) {
    bridge_.PostLatest(Bridge::Stream::kProgress,
                       [this, job, done, total, text = QString::fromStdString(what)] {
                         if (job == jobs_ && is_busy_) emit Progressed(done, total, text);
                       });
  });
  job_stop_ = std::stop_source();
  job_thread_.InsteadOfThis([this, job, progress, work = std::move(work), on_done = std::move(on_done),
                             own_stop = job_stop_](const std::stop_token& thread_stop) {
    std::stop_source stop = own_stop;
    const std::stop_callback forward(thread_stop, [&stop] { stop.request_stop(); });
    std::exception_ptr failure;
    try {
      core::ThrowIfStopped(stop.get_token(), "what was asked");
      work(progress, stop.get_token());
    } catch (...) {  // the thread's outermost frame: nothing may escape
      failure = std::current_exception();
    }
    bridge_.Post([this, job, failure, on_done] { FinishJob(job, failure, on_done); });
  });
  emit StateChanged();
}

void ReviewDesk::TryJob(Work work, std::function<void()> on_done) {
  if (is_busy_) {
    emit Failed(tr("Something else is being done with this session: wait for it, or cancel it"));
  } else {
    RunJob(std::move(work), std::move(on_done));
  }
}

void ReviewDesk::FinishJob(std::int64_t job, const std::exception_ptr& failure,
                           const std::function<void()>& on_done) {
  if (job != jobs_) return;  // another one took its place
  is_busy_ = false;
  if (!failure) {
    on_done();
  } else if (IsCancelled(failure)) {
    emit Noted(tr("Cancelled: nothing was written"));
  } else {
    emit Failed(LineOf(failure));
  }
  emit StateChanged();
}

void ReviewDesk::CancelJob() {
  if (is_busy_) job_stop_.request_stop();
}

void ReviewDesk::Open(const std::filesystem::path& session) {
  auto opened = std::make_shared<std::shared_ptr<control::ReviewedSession>>();
  RunJob(
      [session, opened](const core::Progress& progress, const std::stop_token& stop) {
        *opened = std::make_shared<control::ReviewedSession>(session, progress, stop);
      },
      [this, opened] { TakeSession(std::move(*opened)); });
}

void ReviewDesk::FindHeat() {
  if (heat_ != nullptr) return emit HeatFound(heat_);
  heat_thread_.InsteadOfThis([this, session = session_](const std::stop_token& stop) {
    std::vector<core::SharedMesh> meshes;
    for (const core::Part& part : session->header().layout.parts) meshes.push_back(part.mesh);
    control::HeatLayerMaker maker(std::move(meshes));
    for (const core::HeatMap& map : session->heat_maps()) {
      if (stop.stop_requested()) return;
      maker.Take(map);
    }
    bridge_.Post([this, session, heat = maker.Make()] {
      if (session != session_) return;  // another one was opened
      heat_ = heat;
      emit HeatFound(heat_);
    });
  });
}

void ReviewDesk::TakeSession(std::shared_ptr<control::ReviewedSession> session) {
  // The old one's thread may be in the middle of a frame: it is waited for elsewhere.
  motion_thread_.InsteadOfThis([old = std::move(scrubber_)](const std::stop_token&) {});
  ++asked_;
  session_ = std::move(session);
  held_mm_.clear();
  what_if_.reset();
  heat_.reset();
  position_ = 0;
  scrubber_ = std::make_shared<control::FrameScrubber>(
      session_, [this, of = session_.get()](const control::ScrubbedFrame& frame) {
        bridge_.PostLatest(Bridge::Stream::kFrame, [this, of, frame] {
          if (of == session_.get()) emit FrameArrived(frame);
        });
      });
  TakeFindings();
  emit Opened();
  AskForFrame();
}

void ReviewDesk::TakeFindings() {
  findings_ = control::ListFindings(*session_);
  timeline_ = control::TimelineOf(*session_, findings_);
}

void ReviewDesk::Show(std::size_t position) {
  position_ = std::min(position, session_->frames().size() - 1);
  AskForFrame();
}

void ReviewDesk::AskForFrame() { scrubber_->Ask(position_, held_mm_); }

void ReviewDesk::Hold(control::HeldGaps held_mm) {
  if (held_mm == held_mm_) return;
  held_mm_ = std::move(held_mm);
  what_if_.reset();
  ++asked_;
  AskForFrame();
  if (held_mm_.empty()) {
    motion_thread_.Cancel();
    emit WhatIfArrived();
  } else {
    JudgeMotion();
  }
}

void ReviewDesk::JudgeMotion() {
  motion_thread_.InsteadOfThis([this, asked = asked_, session = session_,
                                held_mm = held_mm_](const std::stop_token& stop) {
    const core::Progress progress([this, asked](std::int64_t done, std::int64_t total, const std::string&) {
      bridge_.PostLatest(Bridge::Stream::kHull, [this, asked, done, total] {
        if (asked == asked_) emit WhatIfProgressed(done, total);
      });
    });
    try {
      auto what_if =
          std::make_shared<control::WhatIf>(control::JudgeMotionAt(*session, {held_mm}, progress, stop));
      bridge_.Post([this, asked, what_if] {
        if (asked != asked_) return;
        what_if_ = std::move(*what_if);
        emit WhatIfArrived();
      });
    } catch (...) {  // the thread's outermost frame: nothing may escape
      const std::exception_ptr failure = std::current_exception();
      bridge_.Post([this, asked, failure] {
        if (asked != asked_ || IsCancelled(failure)) return;
        Hold({});
        emit Failed(LineOf(failure));
      });
    }
  });
}

void ReviewDesk::Say(const core::FindingId& finding, const core::ReviewRemark& remark) {
  TryJob(
      [session = session_, said = sessions::FindingRemark{finding, remark},
       what = tr("writing the remark").toStdString()](const core::Progress& progress,
                                                      const std::stop_token&) {
        progress.Report(0, 0, what);
        session->Say(std::vector{said});
      },
      [this] {
        TakeFindings();
        emit FindingsChanged();
      });
}

void ReviewDesk::ImportBcf(const std::filesystem::path& file) {
  auto import = std::make_shared<sessions::ReviewImport>();
  TryJob(
      [session = session_, file, import, what = tr("reading the BCF file").toStdString()](
          const core::Progress& progress, const std::stop_token&) {
        progress.Report(0, 0, what);
        *import = session->Import(file);
      },
      [this, file, import] {
        TakeFindings();
        emit FindingsChanged();
        QString note =
            tr("%1: %2 remarks taken over").arg(TextOf(file.filename())).arg(import->remarks.size());
        for (const std::string& line : import->notes) note += "; " + QString::fromStdString(line);
        emit Noted(note);
      });
}

void ReviewDesk::ExportBcf(const std::filesystem::path& file) {
  TryJob(
      [path = session_->path(), file](const core::Progress& progress, const std::stop_token& stop) {
        control::WriteSessionTopics(path, file, progress, stop);
      },
      [this, file] { emit Noted(tr("The touches are in %1, for a CAD team").arg(TextOf(file))); });
}

void ReviewDesk::WriteReport() {
  auto html_file = std::make_shared<std::filesystem::path>();
  TryJob(
      [path = session_->path(), html_file](const core::Progress& progress, const std::stop_token& stop) {
        const control::ReportFiles files =
            control::WriteSessionReport(path, control::ReportFolderFor(path), progress, stop);
        const auto html = std::ranges::find(files.written, ".html", &std::filesystem::path::extension);
        if (html != files.written.end()) *html_file = *html;
      },
      [this, html_file] {
        emit Noted(tr("The report is in %1").arg(TextOf(*html_file)));
        emit ReportWritten(TextOf(*html_file));
      });
}

void ReviewDesk::WriteKeepOut(double edge_mm, const std::filesystem::path& file) {
  auto triangles = std::make_shared<std::size_t>(0);
  TryJob(
      [path = session_->path(), edge_mm, file, triangles](const core::Progress& progress,
                                                          const std::stop_token& stop) {
        control::KeepOutRequest request;
        request.sessions = {path};
        request.edge_mm = edge_mm;
        const control::KeepOut found = control::FindKeepOut(request, progress, stop);
        control::WriteKeepOut(request, found, file);
        *triangles = found.swept.mesh.triangles.size();
      },
      [this, file, triangles] {
        emit Noted(tr("The keep-out volume is in %1: %2 triangles").arg(TextOf(file)).arg(*triangles));
      });
}

void ReviewDesk::FindNeededGap(const std::string& spacing) {
  auto needed = std::make_shared<control::NeededGap>();
  TryJob(
      [session = session_, spacing, needed](const core::Progress& progress, const std::stop_token& stop) {
        *needed = control::FindNeededGap(*session, spacing, progress, stop);
      },
      [this, spacing, needed] { emit NeededGapFound(QString::fromStdString(spacing), *needed); });
}

}  // namespace elbowroom::console
