// The layout that is being edited, with what takes time done by a worker.
#pragma once

#include <QObject>
#include <QString>
#include <QTimer>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/control/layout_editing/layout_document.h"

namespace elbowroom::console {

// There is always a document; at first an empty one. What fails is told by Failed, and changes nothing. A
// while after each change it is kept beside its file in case the program ends. Thread: UI.
class LayoutDesk : public QObject {
  Q_OBJECT

 public:
  // `unsaved_folder`: where a layout that has no file yet is kept; it is made when it is needed.
  explicit LayoutDesk(std::filesystem::path unsaved_folder, QObject* parent = nullptr);
  ~LayoutDesk() override;

  [[nodiscard]] const control::LayoutDocument& document() const { return *document_; }
  [[nodiscard]] bool is_reading() const { return reading_ != nullptr; }
  // It has changes that weren't saved, and that nobody said to discard.
  [[nodiscard]] bool is_unsaved() const;
  // Changes of the present layout's file that another run of the program didn't save.
  [[nodiscard]] bool can_recover() const { return can_recover_; }

  void New();
  void Open(const std::filesystem::path& file);
  void Recover();
  void DiscardRecovery();  // what could be recovered
  void Forget();           // what isn't saved now; what could be recovered stays
  void Keep();             // beside the file, at once: nobody is there to ask, and the program ends
  bool Save();
  bool SaveAs(const std::filesystem::path& file);
  void Undo();
  void Redo();

  // "" if it was done; else the line that says why not.
  QString Apply(const QString& name, const control::LayoutDocument::Change& change,
                const QString& merge_key = {});
  // The names of the new parts; none if they can't be added.
  std::vector<std::string> AddParts(const control::PartPreview& preview,
                                    const std::vector<std::string>& nodes);

 signals:
  void Changed();                            // the document, or whether it is saved
  void Opened(bool has_file);                // another document; after Changed
  void ReadingChanged(const QString& what);  // "": nothing is read
  void Failed(const QString& line);

 private:
  using Reader = std::function<control::LayoutDocument(const core::Progress&, const std::stop_token&)>;
  void Read(const QString& what, Reader reader, bool may_recover);
  void Take(std::unique_ptr<control::LayoutDocument> document, bool may_recover);
  void Autosave();
  // What becomes of an autosave when the layout is saved: one that is offered stays.
  [[nodiscard]] control::LayoutDocument::AutosaveThen OfferedThen() const;
  template <typename Step>
  bool Try(Step step);

  std::filesystem::path unsaved_folder_;
  std::unique_ptr<control::LayoutDocument> document_;
  bool can_recover_ = false;
  std::optional<std::string> forgotten_text_;  // that nobody wants to keep
  QTimer autosave_after_;
  int runs_ = 0;   // files that were begun to be read
  Bridge bridge_;  // before the threads that post to it
  std::unique_ptr<BackgroundJob> reading_;
  std::unique_ptr<BackgroundJob> autosaving_;
};

}  // namespace elbowroom::console
