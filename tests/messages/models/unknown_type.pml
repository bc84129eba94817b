<physicalModel name="test">
<atoms><structuralComponent name="atoms">
  <atom><atomProperties index="0" x="0" y="0" z="0"/></atom>
  <atom><atomProperties index="1" x="1" y="0" z="0"/></atom>
  <atom><atomProperties index="2" x="0" y="1" z="0"/></atom>
  <atom><atomProperties index="3" x="0" y="0" z="1"/></atom>
</structuralComponent></atoms>
<exclusiveComponents><multiComponent name="all">
<structuralComponent name="skin">
  <cell><cellProperties type="TRIANGEL"/><atomRef index="0"/><atomRef index="2"/><atomRef index="1"/></cell>
  <cell><cellProperties type="TRIANGEL"/><atomRef index="0"/><atomRef index="1"/><atomRef index="3"/></cell>
</structuralComponent>
</multiComponent></exclusiveComponents>
</physicalModel>
