"""Places labels on a plot so that none covers a line, a mark or another label."""

MARGIN = 3  # pixels kept free around a label
# Widths of letters in parts of the size of the text: DejaVu Sans, rounded up.
WIDTHS = {0.42: "iljftrI.,:;'|!/()[] ", 0.84: "wG+=<>~ODHNQ&", 1.0: "mMW@%"}
WIDTH_OF = {letter: width for width, letters in WIDTHS.items() for letter in letters}


def text_width(words, size):
    return size * sum(WIDTH_OF.get(letter, 0.68) for letter in words)


class Box:
    """A rectangle, y downwards."""

    def __init__(self, left, top, right, bottom):
        self.left, self.top, self.right, self.bottom = left, top, right, bottom

    @classmethod
    def of_text(cls, x, y, words, size, anchor):
        """The box, margins included, of a text whose base line begins, ends or has its middle at (x, y)."""
        width = text_width(words, size)
        left = x - {"start": 0, "middle": 0.5, "end": 1}[anchor] * width
        return cls(left - MARGIN, y - 0.8 * size - MARGIN, left + width + MARGIN, y + 0.25 * size + MARGIN)

    def meets(self, other):
        return (self.left < other.right and other.left < self.right and self.top < other.bottom
                and other.top < self.bottom)

    def holds(self, other):
        return (self.left <= other.left and other.right <= self.right and self.top <= other.top
                and other.bottom <= self.bottom)

    def meets_segment(self, x0, y0, x1, y1):
        """Clips the segment by the four sides (Liang and Barsky, ACM Transactions on Graphics 3, 1984)."""
        first, last = 0.0, 1.0
        for step, room in ((x0 - x1, x0 - self.left), (x1 - x0, self.right - x0), (y0 - y1, y0 - self.top),
                           (y1 - y0, self.bottom - y0)):
            if step == 0:
                if room < 0:
                    return False
            elif step < 0:
                first = max(first, room / step)
            else:
                last = min(last, room / step)
        return first <= last


class Labels:
    """The labels of one plot, and what they keep off: `segments` of lines, and `boxes` of marks and of labels."""

    def __init__(self, frame):
        self.frame, self.segments, self.boxes = frame, [], []

    def keep_off_path(self, points):
        self.segments += [(*a, *b) for a, b in zip(points, points[1:])]

    def keep_off_mark(self, x, y, radius):
        self.boxes.append(Box(x - radius, y - radius, x + radius, y + radius))

    def conflicts(self, box):
        return sum(box.meets(b) for b in self.boxes) + sum(box.meets_segment(*s) for s in self.segments)

    def find(self, words, size, candidates):
        """(cost, place, box) of the first of the candidates (x, y, anchor) within the frame that covers nothing;
        otherwise of the one that covers least. The cost is the candidate's number, and 1000 for each thing covered.
        """
        best = None
        for number, (x, y, anchor) in enumerate(candidates):
            box = Box.of_text(x, y, words, size, anchor)
            if not self.frame.holds(box):
                continue
            cost = number + 1000 * self.conflicts(box)
            if best is None or cost < best[0]:
                best = cost, (x, y, anchor), box
            if cost < 1000:
                break
        return best

    def place(self, words, size, candidates):
        """The place of a label, which later ones keep off. None if no candidate is within the frame."""
        best = self.find(words, size, candidates)
        if best is None:
            return None
        self.boxes.append(best[2])
        return best[1]

    def place_all(self, labels):
        """The places of several labels (words, size, candidates). Early labels take the room of later ones, so the
        order of placing is the best one among its rotations.
        """
        base, best = self.boxes, None
        for forward in (range(len(labels)), range(len(labels) - 1, -1, -1)):
            for shift in range(len(labels)):
                order = [*forward[shift:], *forward[:shift]]
                self.boxes, total, places = list(base), 0, {}
                for k in order:
                    found = self.find(*labels[k])
                    places[k] = found and found[1]
                    total += found[0] if found else 1e6
                    self.boxes += [found[2]] if found else []
                if best is None or total < best[0]:
                    best = total, places, self.boxes
        self.boxes = best[2] if best else base
        return [best[1][k] for k in range(len(labels))] if best else []


def around(x, y, radii=(11, 14, 18, 22, 26, 31, 36, 42, 48, 55, 62, 70, 78, 87, 96, 108, 120)):
    """Places for the label of a mark at (x, y): right, left, above and below it, and further away."""
    for r in radii:
        yield x + r, y + 4, "start"
        yield x - r, y + 4, "end"
        yield x, y - r, "middle"
        yield x, y + r + 9, "middle"
        for dy in (0.7 * r, -0.7 * r):
            yield x + 0.7 * r, y + dy + 4, "start"
            yield x - 0.7 * r, y + dy + 4, "end"
