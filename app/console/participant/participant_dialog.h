// Where the operator chooses what the participant sees, and by which tracker.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>

#include "app/console/participant/participant_choices.h"

namespace elbowroom::console {

// Stays open beside the operator's window; what is chosen is told at once. Thread: UI.
class ParticipantDialog : public QDialog {
  Q_OBJECT

 public:
  ParticipantDialog(const ParticipantChoices& choices, QWidget* parent);

  [[nodiscard]] ParticipantChoices choices() const;
  void ShowState(const QString& text);  // of tracking, one or two lines
  void SetHeadFile(const QString& head_file) { head_file_->setText(head_file); }
  void ShowOpen(bool is_open);  // whether the participant's window is

 signals:
  void Changed();
  void OpenAsked(bool open);

 private:
  void AddPicture(const ParticipantChoices& choices, QFormLayout* form);
  void AddTracker(const ParticipantChoices& choices, QFormLayout* form);
  [[nodiscard]] QDoubleSpinBox* AddNumber(const char* name, double value, double least, double most,
                                          const QString& unit, const QString& tool_tip);
  void FollowChoices();

  QComboBox* mode_;  // this and all below are owned by Qt as children
  QSpinBox* camera_;
  QComboBox* display_;
  QCheckBox* fills_display_;
  QDoubleSpinBox* ipd_;
  QDoubleSpinBox* fov_;
  QDoubleSpinBox* convergence_;
  QComboBox* source_;
  QSpinBox* port_;
  QLineEdit* head_file_;
  QLabel* state_;
  QPushButton* open_;
};

}  // namespace elbowroom::console
