// Which file to read or to write, asked beside the work: nothing else waits for the answer.
#pragma once

#include <QFlags>
#include <QString>
#include <QWidget>
#include <functional>

namespace elbowroom::console {

// What a file dialog says. `beside` is proposed: a file, or the folder to begin in; "": where the program
// runs.
struct FileQuestion {
  QString title;
  QString beside = {};
  QString filter = {};                // of Qt's form: "Layouts (*.toml);;All files (*)"
  QString suffix = {};                // of a written file whose name has none, without the dot
  bool asks_before_replacing = true;  // a file that is written
};

// Calls `taken` with the file, and never where the user cancels, or where `parent` is gone first. The same
// question that still stands is raised instead of asked again. Thread: UI.
using FileTaken = std::function<void(const QString& file)>;
void AskForFileToRead(QWidget* parent, const FileQuestion& question, FileTaken taken);
void AskForFileToWrite(QWidget* parent, const FileQuestion& question, FileTaken taken);
void AskForFolder(QWidget* parent, const FileQuestion& question, FileTaken taken);

}  // namespace elbowroom::console
