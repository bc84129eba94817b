solid cell
facet normal 0 0 1
