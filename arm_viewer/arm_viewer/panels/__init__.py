"""The panels of the page, one in each file; `panel.Panel` is their interface."""
