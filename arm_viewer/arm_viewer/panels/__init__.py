"""The parts of the page, one in a file; `panel.Panel` says what each has."""
