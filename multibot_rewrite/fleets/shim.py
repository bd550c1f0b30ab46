from multibot_rewrite.graph.snapshot import Snapshot, Environment
class System(Snapshot):
    def __new__(cls, nodes=(), ends=(), edges=(), **kw):
        return Snapshot(nodes, ends, edges, Environment(0,"",(),"","",False,0,"",0.0,()))
