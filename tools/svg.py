"""A page of SVG, and the command line of the tools that draw one from a file."""

import sys


def page(width, height, parts):
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        'font-family="sans-serif" font-size="11">\n<rect width="100%" height="100%" fill="white"/>\n'
        + "\n".join(parts)
        + "\n</svg>\n"
    )


def main(usage, draw):
    """draw(path of the input) gives the page."""
    if len(sys.argv) != 3:
        sys.exit(usage)
    text = draw(sys.argv[1])
    with open(sys.argv[2], "w", encoding="utf-8") as out:
        out.write(text)
