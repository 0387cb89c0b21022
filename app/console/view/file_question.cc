#include "app/console/view/file_question.h"

#include <QFileDialog>
#include <QFileInfo>
#include <utility>

namespace elbowroom::console {
namespace {

void Begin(QFileDialog* dialog, const QString& beside) {
  if (beside.isEmpty()) return;
  const QFileInfo file(beside);
  dialog->setDirectory(file.isDir() ? beside : file.path());
  if (!file.isDir()) dialog->selectFile(file.fileName());
}

void Ask(QWidget* parent, const FileQuestion& question, QFileDialog::AcceptMode accepts,
         QFileDialog::FileMode takes, FileTaken taken) {
  for (auto* asked : parent->findChildren<QFileDialog*>(QString(), Qt::FindDirectChildrenOnly)) {
    if (asked->windowTitle() != question.title || asked->isHidden()) continue;
    asked->raise();
    return asked->activateWindow();
  }
  auto* dialog = new QFileDialog(parent, question.title, {}, question.filter);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setAcceptMode(accepts);
  dialog->setFileMode(takes);
  dialog->setDefaultSuffix(question.suffix);  // before the dialog asks whether to replace a file
  dialog->setOption(QFileDialog::ShowDirsOnly, takes == QFileDialog::Directory);
  dialog->setOption(QFileDialog::DontConfirmOverwrite, !question.asks_before_replacing);
  Begin(dialog, question.beside);
  QObject::connect(dialog, &QFileDialog::fileSelected, parent, std::move(taken));
  dialog->show();
}

}  // namespace

void AskForFileToRead(QWidget* parent, const FileQuestion& question, FileTaken taken) {
  Ask(parent, question, QFileDialog::AcceptOpen, QFileDialog::ExistingFile, std::move(taken));
}

void AskForFileToWrite(QWidget* parent, const FileQuestion& question, FileTaken taken) {
  Ask(parent, question, QFileDialog::AcceptSave, QFileDialog::AnyFile, std::move(taken));
}

void AskForFolder(QWidget* parent, const FileQuestion& question, FileTaken taken) {
  Ask(parent, question, QFileDialog::AcceptOpen, QFileDialog::Directory, std::move(taken));
}

}  // namespace elbowroom::console
