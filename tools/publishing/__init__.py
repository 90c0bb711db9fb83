"""What the machine writes into documents: measured figures, tables of the variables, the page of the coverage."""
