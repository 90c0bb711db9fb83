"""The site of all documents, by Sphinx."""
