"""CGAL by its Python bindings: box_self_intersection_d, with closed boxes."""

from CGAL import CGAL_Box_intersection_d as boxes_of
from CGAL.CGAL_Kernel import Bbox_3
from wire import Culler, serve


class Adapter(Culler):
    def frame(self, boxes):
        given = [boxes_of.Box_with_id_3(Bbox_3(*box), number) for number, box in enumerate(boxes.astype(float).tolist())]
        found = boxes_of.Collect_ids_callback_3()
        boxes_of.box_self_intersection_d(given, found)
        return self.pairs(list(found.ids()))


if __name__ == "__main__":
    serve(Adapter, "cgal")
