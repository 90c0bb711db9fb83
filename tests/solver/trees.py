"""Rooted trees and the order conditions of a Runge-Kutta method (Hairer, Norsett, Wanner I, section II.2)."""

from functools import cache
from itertools import combinations_with_replacement
from math import prod


@cache
def trees(order):
    """All rooted trees with `order` nodes, as sorted tuples of their branches."""
    return tuple({tuple(sorted(branches)) for branches in forests(order - 1, order - 1)})


@cache
def forests(nodes, largest):
    """All multisets of trees with `nodes` nodes together and at most `largest` each."""
    if nodes == 0:
        return ((),)
    found = []
    for size in range(1, min(nodes, largest) + 1):
        for count in range(1, nodes // size + 1):
            for rest in forests(nodes - count * size, size - 1):
                for chosen in combinations_with_replacement(trees(size), count):
                    found.append(chosen + rest)
    return tuple(found)


def nodes(tree):
    return 1 + sum(map(nodes, tree))


def gamma(tree):
    """The density: the product of the sizes of all subtrees."""
    return nodes(tree) * prod(map(gamma, tree))


def stage_values(tree, a):
    """Elementary weight of each stage: the product over the branches of sum_j a_ij (branch at stage j)."""
    values = [1.0] * len(a)
    for branch in tree:
        inner = stage_values(branch, a)
        for i, row in enumerate(a):
            values[i] *= sum(weight * inner[j] for j, weight in row)
    return values


def residuals(weights, a, order, at=1.0):
    """sum_i weights_i (tree at stage i) - at^order / gamma for every tree of the order; zero if it is reached."""
    return [
        sum(weight * value for weight, value in zip(weights, stage_values(tree, a), strict=True))
        - at**order / gamma(tree)
        for tree in trees(order)
    ]
