#include "app/console/reviews/keep_out_dialog.h"

#include <QDialogButtonBox>
#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QVBoxLayout>
#include <algorithm>
#include <array>
#include <utility>

#include "app/console/view/file_question.h"

namespace elbowroom::console {
namespace {

constexpr std::array kEndings = {".stl", ".ply", ".glb"};

bool HasKnownEnding(const QString& file) {
  return std::ranges::any_of(kEndings,
                             [&](const char* ending) { return file.endsWith(ending, Qt::CaseInsensitive); });
}

}  // namespace

KeepOutDialog::KeepOutDialog(const std::filesystem::path& session, QWidget* parent)
    : QDialog(parent), edge_(new QDoubleSpinBox), file_(new QLineEdit) {
  setWindowTitle(tr("Keep-out volume"));
  setObjectName("keep_out_dialog");
  edge_->setObjectName("keep_out_edge");
  edge_->setAccessibleName(tr("Edge of the cells, mm"));
  edge_->setToolTip(
      tr("Edge of the cells that the volume is made of, mm: half of it is about its error, and a "
         "quarter of it takes sixteen times as long"));
  edge_->setRange(0.5, 100.0);
  edge_->setValue(5.0);
  edge_->setSuffix(tr(" mm"));
  file_->setObjectName("keep_out_file");
  file_->setAccessibleName(tr("File"));
  file_->setToolTip(
      tr("A mesh in mm: .stl, .ply or .glb; the latter two with how long each place was taken"));
  file_->setText(QString::fromStdString((session.parent_path() / session.stem()).string()) + "-keep-out.stl");
  auto* browse = new QPushButton(tr("&Browse …"));
  browse->setToolTip(tr("Choose the file"));
  connect(browse, &QPushButton::clicked, this, &KeepOutDialog::Browse);
  auto* file_row = new QHBoxLayout;
  file_row->addWidget(file_, 1);
  file_row->addWidget(browse);
  auto* form = new QFormLayout;
  form->addRow(tr("&Edge of its cells"), edge_);
  auto* file_label = new QLabel(tr("&File"));
  file_label->setBuddy(file_);
  form->addRow(file_label, file_row);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel);
  write_ = buttons->addButton(tr("&Write"), QDialogButtonBox::AcceptRole);
  write_->setObjectName("keep_out_write");
  connect(buttons, &QDialogButtonBox::accepted, this, &KeepOutDialog::Accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(file_, &QLineEdit::textChanged, this,
          [this](const QString& file) { write_->setEnabled(HasKnownEnding(file)); });
  auto* what =
      new QLabel(tr("The space that hands and tools took in this session, as a closed mesh: "
                    "what CAD must leave free."));
  what->setWordWrap(true);
  auto* column = new QVBoxLayout(this);
  column->addWidget(what);
  column->addLayout(form);
  fault_ = new QLabel;
  fault_->setObjectName("keep_out_fault");
  fault_->setWordWrap(true);
  fault_->setTextFormat(Qt::PlainText);
  fault_->hide();
  column->addWidget(fault_);
  column->addWidget(buttons);
  resize(520, sizeHint().height());
}

void KeepOutDialog::Browse() {
  AskForFileToWrite(this,
                    {.title = tr("Write the keep-out volume into"),
                     .beside = file_->text(),
                     .filter = tr("Meshes (*.stl *.ply *.glb)")},
                    [this](const QString& file) {
                      file_->setText(file);
                      may_replace_ = file;  // the file dialog has asked
                    });
}

void KeepOutDialog::Accept() {
  const QString file = file_->text();
  if (QFileInfo::exists(file) && file != std::exchange(may_replace_, file)) {
    fault_->setText(tr("%1 is there; choose another name, or press again to replace it").arg(file));
    return fault_->show();
  }
  emit Asked(edge_->value(), file_->text().toStdString());
  accept();
}

}  // namespace elbowroom::console
