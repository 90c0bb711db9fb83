"""The repository itself: its checkout, commands, documents and releases."""
