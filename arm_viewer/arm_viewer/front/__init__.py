"""Our additions to viser's page: title, icon, style and scripts."""
