"""Tables of variables, figures in prose, pages from templates."""
