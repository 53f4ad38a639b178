"""A page of docs with its pictures."""


class Page:
    """`name`.md in `docs`; pictures are images/`prefix`_*.png."""

    def __init__(self, docs, name, prefix):
        self.docs, self.name, self.prefix, self.parts = docs, name, prefix, []

    def add(self, text):
        self.parts.append(text.strip("\n"))

    def add_picture(self, name, figure, caption):
        file = f"images/{self.prefix}_{name}.png"
        figure.savefig(self.docs / file, dpi=80)
        self.add(f"![{caption}]({file})")

    def write(self):
        file = self.docs / f"{self.name}.md"
        file.write_text("\n\n".join(self.parts) + "\n", encoding="utf-8")
        print(f"\nPage: {file.resolve()}")
