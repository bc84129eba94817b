<physicalModel name="test">
<atoms><structuralComponent name="atoms">
  <atom><atomProperties index="0" x="0" y="0" z="0"/></atom>
  <atom><atomProperties index="1" x="1" y="0" z="0"/></atom>
  <atom><atomProperties index="2" x="0" y="1" z="0"/></atom>
  <atom><atomProperties index="3" x="0" y="0" z="1"/></atom>
</structuralComponent></atoms>
<exclusiveComponents><multiComponent name="all">
<structuralComponent name=