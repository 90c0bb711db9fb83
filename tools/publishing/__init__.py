"""Parts of the documents that programs write, and the site."""
