"""The lab: what is built with the product. Each folder can be deleted alone; the product imports none of them."""
