// The layout's parts by name: which are shown, which are chosen.
#pragma once

#include <QStringList>
#include <QTreeWidget>

#include "app/console/layouts/part_look.h"
#include "core/layout.h"

namespace elbowroom::console {

// A tick shows a part; a click chooses one, a Ctrl+click a second one; F2 renames. Thread: UI.
class PartsList : public QTreeWidget {
  Q_OBJECT

 public:
  explicit PartsList(QWidget* parent = nullptr);

  void Show(const core::Layout& layout, const PartLooks& looks, const QStringList& chosen);

 signals:
  void Chosen(const QStringList& parts);                     // one or two, the first one first; none
  void RenameAsked(const QString& part, const QString& to);  // by F2
  void VisibilityChanged(const QString& part, bool is_visible);

 private:
  void TakeSelection();

  QStringList chosen_;
};

// `part` added to what is chosen, or alone: what a click does. A second click with Ctrl takes it out again.
[[nodiscard]] QStringList WithClick(const QStringList& chosen, const QString& part, bool adds);

}  // namespace elbowroom::console
