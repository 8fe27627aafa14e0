"""The screens: Qt widgets and view models; no arithmetic, no file formats."""
