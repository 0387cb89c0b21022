#include "app/console/layouts/layout_desk.h"

#include <chrono>
#include <utility>

#include "app/control/layout_editing/autosave.h"
#include "core/error.h"
#include "core/system/file_sync.h"

namespace elbowroom::console {
namespace {

constexpr std::chrono::milliseconds kAutosaveAfter(2000);

}  // namespace

LayoutDesk::LayoutDesk(std::filesystem::path unsaved_folder, QObject* parent)
    : QObject(parent),
      unsaved_folder_(std::move(unsaved_folder)),
      document_(std::make_unique<control::LayoutDocument>(unsaved_folder_)) {
  can_recover_ = control::FindAutosave(document_->file()).has_value();
  autosave_after_.setSingleShot(true);
  autosave_after_.setInterval(kAutosaveAfter);
  connect(&autosave_after_, &QTimer::timeout, this, &LayoutDesk::Autosave);
}

LayoutDesk::~LayoutDesk() = default;

template <typename Step>
bool LayoutDesk::Try(Step step) {
  try {
    step();
    return true;
  } catch (const core::Error& error) {
    emit Failed(QString::fromStdString(error.what()));
    return false;
  }
}

void LayoutDesk::New() {
  ++runs_;
  reading_.reset();
  emit ReadingChanged({});
  Take(std::make_unique<control::LayoutDocument>(unsaved_folder_), can_recover_ && !document_->has_file());
  emit Opened(false);
}

void LayoutDesk::Open(const std::filesystem::path& file) {
  Read(
      QString::fromStdString(file.filename().string()),
      [file](const core::Progress& progress, const std::stop_token& stop) {
        return control::LayoutDocument::Open(file, progress, stop);
      },
      true);
}

void LayoutDesk::Recover() {
  Read(
      QString::fromStdString(document_->file().filename().string()),
      [file = document_->file()](const core::Progress& progress, const std::stop_token& stop) {
        return control::LayoutDocument::Recover(file, progress, stop);
      },
      false);
}

void LayoutDesk::Read(const QString& what, Reader reader, bool may_recover) {
  auto read = std::make_shared<std::unique_ptr<control::LayoutDocument>>();
  const int run = ++runs_;
  const core::Progress progress([this, run, what](std::int64_t, std::int64_t, const std::string& step) {
    bridge_.PostLatest(Bridge::Stream::kProgress, [this, run, what, text = QString::fromStdString(step)] {
      if (reading_ && run == runs_) emit ReadingChanged(tr("%1: %2").arg(what, text));
    });
  });
  reading_ = std::make_unique<BackgroundJob>(
      bridge_,
      [read, progress, reader = std::move(reader)](const std::stop_token& stop) {
        *read = std::make_unique<control::LayoutDocument>(reader(progress, stop));
      },
      [this, read, run, what, may_recover, before = document_->text().text()](const std::string& error) {
        if (run != runs_) return;  // another file was opened since: its job runs
        reading_.reset();
        emit ReadingChanged({});
        if (!error.empty()) return emit Failed(QString::fromStdString(error));
        if (is_unsaved() && document_->text().text() != before)
          return emit Failed(
              tr("%1 isn't opened: the layout was changed meanwhile; open it again").arg(what));
        Take(std::move(*read), may_recover);
        emit Opened(document_->has_file());
      });
  emit ReadingChanged(what);
}

void LayoutDesk::Take(std::unique_ptr<control::LayoutDocument> document, bool may_recover) {
  autosave_after_.stop();
  document_ = std::move(document);
  forgotten_text_.reset();
  can_recover_ = may_recover && control::FindAutosave(document_->file()).has_value();
  emit Changed();
}

bool LayoutDesk::is_unsaved() const {
  return document_->is_changed() && document_->text().text() != forgotten_text_;
}

void LayoutDesk::Keep() {
  if (!is_unsaved()) return;
  autosave_after_.stop();
  autosaving_.reset();
  Try([this] {
    core::MakeFolder(core::FolderOf(document_->file()));
    if (can_recover_) {
      control::AppendAutosave(document_->text());  // what is offered stays, and is offered first
    } else {
      document_->Autosave();
    }
  });
  forgotten_text_ = document_->text().text();
}

void LayoutDesk::Forget() {
  autosave_after_.stop();
  autosaving_.reset();  // waits for what is being written
  if (!can_recover_) control::DropAutosave(document_->file());
  forgotten_text_ = document_->text().text();
  emit Changed();
}

void LayoutDesk::DiscardRecovery() {
  if (!can_recover_) return;
  control::DropAutosave(document_->file());
  can_recover_ = control::FindAutosave(document_->file()).has_value();  // the next
  autosave_after_.start();  // of what was changed while it was offered
  emit Changed();
}

control::LayoutDocument::AutosaveThen LayoutDesk::OfferedThen() const {
  using Then = control::LayoutDocument::AutosaveThen;
  return can_recover_ ? Then::kKept : Then::kDropped;
}

bool LayoutDesk::Save() {
  autosave_after_.stop();
  autosaving_.reset();
  const bool is_saved = Try([this] { document_->Save(OfferedThen()); });
  if (is_saved) can_recover_ = control::FindAutosave(document_->file()).has_value();
  emit Changed();
  return is_saved;
}

bool LayoutDesk::SaveAs(const std::filesystem::path& file) {
  autosave_after_.stop();
  autosaving_.reset();
  const bool is_saved = Try([this, &file] { document_->SaveAs(file, OfferedThen()); });
  if (is_saved) can_recover_ = false;  // what was offered stays beside the other file
  emit Changed();
  return is_saved;
}

void LayoutDesk::Undo() {
  if (!document_->CanUndo()) return;
  document_->Undo();
  autosave_after_.start();
  emit Changed();
}

void LayoutDesk::Redo() {
  if (!document_->CanRedo()) return;
  document_->Redo();
  autosave_after_.start();
  emit Changed();
}

QString LayoutDesk::Apply(const QString& name, const control::LayoutDocument::Change& change,
                          const QString& merge_key) {
  try {
    document_->Apply(name.toStdString(), change, merge_key.toStdString());
  } catch (const core::Error& error) {
    return QString::fromStdString(error.what());
  }
  autosave_after_.start();
  emit Changed();
  return {};
}

std::vector<std::string> LayoutDesk::AddParts(const control::PartPreview& preview,
                                              const std::vector<std::string>& nodes) {
  std::vector<std::string> names;
  const auto add = [&] {
    // Files are named as seen from there, which takes a folder that is there.
    if (!document_->has_file()) core::MakeFolder(unsaved_folder_);
    names = document_->AddParts(preview, nodes, [](const std::vector<std::string>& parts) {
      return (parts.size() == 1 ? tr("Add %1").arg(QString::fromStdString(parts.front()))
                                : tr("Add %1 parts").arg(parts.size()))
          .toStdString();
    });
  };
  if (Try(add)) {
    autosave_after_.start();
    emit Changed();
  }
  return names;
}

void LayoutDesk::Autosave() {
  if (!is_unsaved() || can_recover_) return;  // what is offered isn't overwritten
  if (autosaving_) return autosave_after_.start();
  autosaving_ = std::make_unique<BackgroundJob>(
      bridge_,
      [text = document_->text()](const std::stop_token&) {
        core::MakeFolder(core::FolderOf(text.file()));
        control::WriteAutosave(text);
      },
      [this](const std::string& error) {
        autosaving_.reset();
        if (!error.empty()) emit Failed(QString::fromStdString(error));
      });
}

}  // namespace elbowroom::console
