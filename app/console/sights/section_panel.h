// Where parts and hull are cut open: named planes at any angle, saved with the layout.
#pragma once

#include <Eigen/Geometry>
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QSlider>
#include <QToolButton>
#include <QWidget>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/control/section/section_list.h"

namespace elbowroom::console {

// The planes of a layout that has a file of the user's own are that file's, and saved there when asked. Those
// of other layouts (the demo's) are taken from the last run and left for the next. Thread: UI.
class SectionPanel : public QWidget {
  Q_OBJECT

 public:
  explicit SectionPanel(QWidget* parent = nullptr);
  ~SectionPanel() override;

  // The planes can be moved within the workspace. `layout_file`: empty where there is none of the user's own.
  void Open(const Eigen::AlignedBox3d& workspace_mm, const std::filesystem::path& layout_file = {},
            const std::vector<control::Section>& sections = {});

  // What is cut while the panel is shown; nothing otherwise.
  [[nodiscard]] control::SectionCut cut() const;
  [[nodiscard]] const std::vector<control::Section>& sections() const { return list_.now(); }
  [[nodiscard]] const Eigen::AlignedBox3d& workspace_mm() const { return workspace_mm_; }
  // The plane that handles, numbers and drags are for; nothing unless it is on, and the panel shown.
  [[nodiscard]] std::optional<control::Section> active() const;
  // Of the plane that is chosen in the list, on or not.
  [[nodiscard]] std::optional<std::size_t> active_index() const {
    return active_ < sections().size() ? std::optional(active_) : std::nullopt;
  }
  // In place of the active one. Changes up to EndStep() are one step back.
  void SetActive(const control::Section& section);
  void EndStep() { list_.EndStep(); }
  // Moves the active plane along its normal.
  void Drag(const Eigen::Vector3d& by_in_world_mm);
  // Beside the others, active and on.
  void Add(const QString& wanted_name, const Eigen::Vector3d& normal, const Eigen::Vector3d& x_in_world);
  void SetAligning(bool is_on);  // whether the next click in the view is to pick a face

 signals:
  void Changed(const elbowroom::control::SectionCut& cut);  // or another plane is active
  void AlignAsked(bool is_on);
  void FacingAsked();  // a plane that faces the view
  void Failed(const QString& line);

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  void MakeList();
  void MakeNumbers();
  void MakeButtons();
  QToolButton* Button(const char* name, const QString& text, const QString& tool_tip);
  QDoubleSpinBox* Number(const char* name, const QString& spoken, const QString& tool_tip, double most,
                         const QString& suffix);
  [[nodiscard]] QMenu* AddMenu();
  [[nodiscard]] std::vector<control::Section> FirstSections() const;
  void Change(std::vector<control::Section> next, const std::string& merge_key = {});
  void TakeNumbers();
  void TakeName();
  void Remove();
  void Save();
  void Choose(int row);
  void Show();  // the list's planes, in the controls
  void ShowActive();
  void Remember() const;

  QListWidget* planes_ = nullptr;
  QLineEdit* name_ = nullptr;
  QSlider* slider_ = nullptr;
  QDoubleSpinBox *offset_mm_ = nullptr, *azimuth_deg_ = nullptr, *elevation_deg_ = nullptr;
  QToolButton *add_ = nullptr, *remove_ = nullptr, *flip_ = nullptr, *align_ = nullptr, *undo_ = nullptr,
              *redo_ = nullptr, *save_ = nullptr;
  QLabel* state_ = nullptr;
  control::SectionList list_;
  std::size_t active_ = 0;
  Eigen::AlignedBox3d workspace_mm_;
  std::filesystem::path layout_file_;
  std::vector<control::Section> saved_;
  Bridge bridge_;  // before the thread that posts to it
  std::unique_ptr<BackgroundJob> saving_;
};

}  // namespace elbowroom::console
